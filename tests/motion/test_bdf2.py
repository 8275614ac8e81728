"""The paper's scheme: second order in Δs and in Δt, towards what the reference methods and Radau IIA give."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from rodloop_cli import Case, simulate

CONTRAST = json.loads((Path(__file__).parents[1] / "reference" / "data" / "stiffness5_p3.8.json").read_text())
LAST = 1.25
SLOW = {"p": 3.8, "perturbation": [{"mode": 2, "amplitude": 0.02}], "t_end": 2.0}
"""Leaves the waves that a coarse step cannot follow, modes 6 and up, unexcited: the slopes show at once."""
FAST = {"p": 16.0, "perturbation": [{"mode": 3, "amplitude": 0.005}], "t_end": 0.5}


@cache
def at_the_end(kind, **numerics):
    """Positions, area, bending energy and kinetic energy at the last time."""
    run = simulate(Case(**(SLOW if kind == "slow" else FAST), snapshots=2, output_points=8, **numerics)).isel(t=-1)
    return {
        "position": np.concatenate([run.x, run.y]),
        "area": run.area.values,
        "bending energy": run.bending_energy.values,
        "kinetic energy": run.kinetic_energy.values,
    }


def largest(a, b):
    return {key: float(np.abs(a[key] - b[key]).max()) for key in a}


def slopes(runs):
    """Orders that the differences of three runs, each twice as fine as the one before, show."""
    coarse, fine = largest(runs[0], runs[1]), largest(runs[1], runs[2])
    return {key: np.log2(coarse[key] / fine[key]) for key in coarse}


def test_second_order_in_the_time_step():
    runs = [at_the_end("fast", scheme="bdf2", N=32, dt=dt) for dt in (0.0125, 0.00625, 0.003125)]
    assert slopes(runs) == pytest.approx(dict.fromkeys(runs[0], 2.0), abs=0.2)


def test_second_order_in_the_cell_length():
    runs = [at_the_end("slow", scheme="bdf2", N=N, dt=0.05) for N in (64, 128, 256)]
    assert slopes(runs) == pytest.approx(dict.fromkeys(runs[0], 2.0), abs=0.2)


def test_both_schemes_tell_the_same_motion():
    """With Δs and Δt halved together, one extrapolation leaves the error of fourth order."""
    exact = at_the_end("slow", tol=1e-7)
    coarse, fine = (at_the_end("slow", scheme="bdf2", N=N, dt=0.8 / N) for N in (64, 128))
    extrapolated = {key: (4 * fine[key] - coarse[key]) / 3 for key in fine}
    assert max(largest(extrapolated, exact).values()) < 1e-4
    assert max(largest(fine, exact).values()) < 6e-3


def with_contrast(N, dt):
    """(5, T): area, bending energy change, kinetic energy and two distances at the reference times."""
    times = tuple(row["t"] for row in CONTRAST["observables"] if row["t"] <= LAST)
    case = Case(**CONTRAST["case"], t_end=LAST, snapshot_times=times, output_points=8, scheme="bdf2", N=N, dt=dt)
    run = simulate(case)
    x, y, bending = run.x.values, run.y.values, run.bending_energy.values
    distances = (np.hypot(x[:, a] - x[:, b], y[:, a] - y[:, b]) for a, b in ((0, 4), (2, 6)))
    return np.stack([run.area.values, bending - bending[0], run.kinetic_energy.values, *distances])


def test_a_loop_with_stiffness_contrast_converges_to_the_reference():
    keys = ("area", "bending_energy_change", "kinetic_energy", "distance_junctions", "distance_midpoints")
    expected = np.array([[row[key] for row in CONTRAST["observables"] if row["t"] <= LAST] for key in keys])
    scale = np.abs(expected).max(axis=1, keepdims=True)
    coarse, fine = with_contrast(128, 0.005), with_contrast(256, 0.0025)
    errors = [np.abs((run - expected) / scale).max(axis=1) for run in (coarse, fine, (4 * fine - coarse) / 3)]
    assert (errors[1] < 2e-3).all()
    assert np.log2(errors[0] / errors[1]) == pytest.approx(np.full(len(keys), 2.0), abs=0.2)
    assert (errors[2] < 2e-4).all()


def test_a_factorization_serves_many_steps():
    """Newton ends at the same loop to its target, whatever the linearisation; what is left of it grows here."""
    given = FAST | {"scheme": "bdf2", "N": 40, "dt": 0.005, "snapshots": 6}
    kept = simulate(Case(**given))
    assert kept.attrs["total_factorizations"] < kept.attrs["total_steps"] / 4
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rodloop_cli.march.newton.REUSE_BELOW", 0.0)
        anew = simulate(Case(**given))
    assert anew.attrs["total_factorizations"] >= anew.attrs["total_steps"]
    np.testing.assert_allclose(kept.x, anew.x, rtol=0, atol=1e-6)


def test_rows_within_a_step_are_of_second_order_too():
    """Moment and force as well: the bending energy half way through a step."""
    middle, energies = 0.25, []
    for steps in (20, 40, 80, 320):
        fixed = {"scheme": "bdf2", "N": 32, "dt": middle / (steps + 0.5)}
        stored = {"snapshot_times": (middle,), "output_points": 8, "t_end": 0.3}
        energies.append(simulate(Case(**FAST | fixed | stored)).bending_energy.item())
    errors = np.abs(np.array(energies[:3]) - energies[3])
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx([2.0, 2.0], abs=0.3)


@pytest.mark.parametrize("excess", [1e-5, 1e-7, 1e-9])
def test_the_last_step_is_no_sliver(excess):
    """What Newton leaves would be closed with forces of that over Δt²: 571 and more instead of 5.8."""
    loop = {"p": 3.8, "stiffness_ratio": 5.0, "scheme": "bdf2", "N": 40, "dt": 0.01, "snapshots": 3}
    whole, longer = (simulate(Case(**loop, t_end=t_end)) for t_end in (0.5, 0.5 + excess))
    np.testing.assert_allclose(longer.axial_force[-1], whole.axial_force[-1], rtol=0, atol=0.05)
    assert longer.attrs["total_steps"] <= 51
