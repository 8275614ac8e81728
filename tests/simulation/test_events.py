"""Coming to rest, and swings of the area."""

import pytest

from rodloop_cli import Case, simulate

ABOUT_TO_BUCKLE = {"p": 4.0, "zeta_perp": 10.0, "tol": 1e-3, "t_end": 100.0, "stop_at": ("settled",), "snapshots": 3}


def test_the_state_at_rest_is_stored():
    """Long before the second stored time."""
    run = simulate(Case(p=2.0, stiffness_ratio=5.0, zeta_perp=20.0, t_end=1000.0, snapshots=20, stop_at=("settled",)))
    assert run.attrs["outcome"].startswith("settled")
    assert run.t.size == 2
    assert float(run.t[-1]) < 1000 / 19
    assert float(run.kinetic_energy[-1]) < 1e-6
    assert float(run.area[-1]) < float(run.area[0]) - 0.09
    assert 0 < run.attrs["largest_energy_residual"] < 1e-5


@pytest.mark.parametrize("amplitude", [1e-5, 3e-4])
def test_a_loop_that_is_about_to_buckle_is_not_at_rest(amplitude):
    """It is slow, and nearer to the circle than tol."""
    run = simulate(Case(**ABOUT_TO_BUCKLE, perturbation=[{"mode": 2, "amplitude": amplitude}]))
    assert run.attrs["outcome"].startswith("settled")
    assert float(run.area[-1]) == pytest.approx(1.779, abs=2e-3)


def test_round_off_has_no_minima():
    """Neither of a circle at rest, nor where an overdamped loop comes to rest."""
    resting = simulate(Case(p=3.0, t_end=1.0))
    creeping = simulate(Case(p=2.0, stiffness_ratio=5.0, zeta_perp=20.0, t_end=100.0))
    for run in (resting, creeping):
        assert "first_area_minimum" not in run.attrs
        assert "period" not in run.attrs


def test_ripples_do_not_hide_the_swing():
    swinging = simulate(Case(p=3.8, stiffness_ratio=5.0, t_end=4.0))
    assert swinging.attrs["first_area_minimum_time"] == pytest.approx(1.1329, abs=1e-3)
    assert swinging.attrs["period"] == pytest.approx(2.2496, abs=2e-3)
    random = {"amplitude": 5e-5, "modes": [2, 20], "seed": 1}
    crossing = simulate(Case(p=16.0, t_end=2.0, perturbation=[{"random": random}]))
    assert "period" not in crossing.attrs
