"""What the random cases of scripts/stress found, kept from coming back."""

import dataclasses

import numpy as np
import pytest

from rodloop_cli import Case, simulate
from rodloop_cli.physics.rod import Segment
from rodloop_cli.simulation import Run
from rodloop_cli.simulation.amplification import SUSPICIOUS, Amplification, growth_rate
from scripts.stress.cases import random_case
from scripts.stress.random_cases import one
from scripts.stress.trial import Rows, attempt

ROWS = {"snapshots": 3, "output_points": 32}


@pytest.mark.parametrize("contrast", [{}, {"stiffness_ratio": 5.0}])
def test_an_amplitude_of_zero_asks_for_no_cells(contrast):
    still = Run.of(Case(p=3.8, t_end=0.1, perturbation=[{"mode": 2, "amplitude": 0.0}], **contrast))
    plain = Run.of(Case(p=3.8, t_end=0.1, **contrast))
    assert still.begun.state.equations.mesh.cells == plain.begun.state.equations.mesh.cells


@pytest.mark.parametrize(
    "case",
    [
        {"p": -27.88, "zeta_perp": 6457.0, "gamma": 1.0, "t_end": 0.458, "tol": 2.9e-6},
        {"p": -13.8, "density_ratio": 817.0, "k": 0.623, "t_end": 2.0, "tol": 1.5e-6},
        {"p": 2.0, "t_end": 3.0, "tol": 1e-9},
        {"p": 0.0, "t_end": 3.0},
    ],
)
def test_a_circle_in_equilibrium_stays(case):
    run = simulate(Case(**case, **ROWS))
    moved = np.abs(run.x.values - run.x.values[0]).max()
    assert run.attrs["outcome"] == "reached t_end"
    assert moved < 1e-5


@pytest.mark.parametrize("ratio", [2.0, 5.0])
def test_a_perturbed_loop_with_kinks_runs_to_a_tight_tolerance(ratio):
    """Its moment jumps at the junctions at t = 0: without short cells there the steps shrink without end."""
    case = {"p": 3.8, "stiffness_ratio": ratio, "t_end": 0.3, "tol": 1e-5, **ROWS}
    trial, _ = attempt(case | {"perturbation": [{"mode": 3, "amplitude": 0.03, "phase": 0.5}]}, 20)
    assert trial.kind == "end"
    assert trial.residual < 0.02


def test_short_cells_beside_long_ones_leave_newton_its_digits():
    """With 20 points in a cell the linear systems were so ill-conditioned that corrections stalled at 1e-10."""
    case = {"p": 8.3, "stiffness_ratio": 2.42, "t_end": 3e-5, "tol": 1e-7, **ROWS}
    trial, _ = attempt(case | {"perturbation": [{"mode": 5, "amplitude": 0.038}]}, 20)
    assert trial.kind == "end"
    assert trial.work["newton_failures"] == 0


@pytest.mark.parametrize("seed", [531, 585, 704])
def test_a_failed_step_of_a_loose_run_can_be_shortened(seed):
    """The gaps that Newton's iteration had left asked for forces of 1/Δt²: the shorter the step, the worse."""
    trial = one(seed, 20, compare=False)
    assert trial.kind == "end"


def test_a_closed_state_is_inextensible_and_closed_already():
    """What Newton's iteration leaves between cells goes away, and nothing more."""
    case = Case(p=20.0, stiffness_ratio=5.0, t_end=0.2, tol=1e-2, **ROWS)
    state = list(Run.of(case).marcher)[-1].end
    closed, twice = state.closed(), state.closed().closed()
    for name in ("unknowns", "rates", "position", "velocity"):
        np.testing.assert_allclose(getattr(twice, name), getattr(closed, name), atol=1e-12)
    np.testing.assert_allclose(closed.position, state.position, atol=1e-4)
    along = np.diff(closed.position[..., -1], axis=1, prepend=closed.position[:, -1:, -1])
    inside = np.stack([np.cos(closed.unknowns[:, 6:]), np.sin(closed.unknowns[:, 6:])]) @ state.equations.rule.weights
    np.testing.assert_allclose(along, inside * state.equations.mesh.lengths, atol=1e-13)


@pytest.mark.parametrize("seed", range(6))
def test_a_random_case_ends_or_says_why(seed):
    trial = one(seed, 20, compare=False)
    assert trial.kind in {"end", "crossing", "settled", "refused"}, trial


def test_an_end_that_the_sum_of_steps_misses_by_a_rounding():
    """0.458 was missed by 5.6e-17, and a step of that length was asked for."""
    run = Run.of(Case(p=3.8, t_end=1.0, **ROWS))
    last = list(run.marcher)[-1].end
    run.marcher.state = dataclasses.replace(last, time=float(np.nextafter(1.0, 0.0)))
    assert list(run.marcher) == []


@pytest.mark.parametrize("ratio", [1e-3, 1e3])
def test_a_jump_of_the_moment_on_coarse_cells_starts_with_a_longer_step(ratio):
    case = {"p": 1.0, "stiffness_ratio": ratio, "scheme": "bdf2", "N": 100, "dt": 0.018, "t_end": 0.09, **ROWS}
    trial, _ = attempt(case | {"perturbation": [{"mode": 2, "amplitude": 5e-3}]}, 20)
    assert trial.kind == "end"


def test_a_run_that_buckles_out_of_its_errors_says_so():
    """Its soft segment has p/b = 13 600: waves of mode 80 grow, and it is some 60 tol off."""
    run = Run.of(Case(**random_case(890)))
    rows = Rows()
    run.into(rows)
    assert run.summary.amplification.excess > SUSPICIOUS
    assert any("buckling waves grew" in text for text in run.summary.warnings)
    for text in run.summary.warnings:
        assert text in rows.attributes["warning"]


@pytest.mark.parametrize("scheme", [{}, {"scheme": "bdf2", "N": 40, "dt": 0.01}])
@pytest.mark.parametrize("amplitude", [0.0, 1e-2])
def test_only_a_perturbation_kinks_a_loop_at_its_junctions(scheme, amplitude):
    perturbation = [{"mode": 2, "amplitude": amplitude}]
    run = Run.of(Case(p=3.8, stiffness_ratio=5.0, t_end=1.0, perturbation=perturbation, **scheme))
    assert bool(run.warning) == (amplitude > 0)
    assert ("tol" in run.warning) == (amplitude > 0 and not scheme)


@pytest.mark.parametrize(
    "case",
    [
        {"p": 3.8, "t_end": 9.6, "perturbation": [{"mode": 2, "amplitude": 5e-3}], "tol": 1e-3},
        {"p": 64.0, "t_end": 0.28, "perturbation": [{"mode": 6, "amplitude": 5e-5}]},
        {"p": 3.8, "stiffness_ratio": 5.0, "t_end": 2.25},
        {"p": 733.0, "t_end": 0.005},
    ],
)
def test_an_ordinary_run_does_not_cry_wolf(case):
    run, rows = Run.of(Case(**case, **ROWS)), Rows()
    run.into(rows)
    assert "warning" not in rows.attributes


def test_growth_is_that_of_the_dispersion_relation():
    """Eq. (17): ω² = 57.6 for n = 3 at p = 16, the largest of all n; the fastest wave of any n is hardly faster."""
    free = growth_rate(Segment(1.0), 0.0, 16.0)
    assert np.sqrt(57.6) <= free < 1.01 * np.sqrt(57.6)
    damped = growth_rate(Segment(1.0, 1.0, 2.0), 5.0, 16.0)
    assert 2.0 * damped**2 + 5.0 * damped == pytest.approx(free**2)
    assert growth_rate(Segment(1.0, 2.0), 0.0, 6.0) == 0.0


def test_the_memory_of_amplification_is_all_there_is():
    run = Run.of(Case(p=64.0, t_end=0.1, perturbation=[{"mode": 6, "amplitude": 5e-5}], **ROWS))
    run.into(Rows())
    seen = run.summary.amplification
    fresh = Amplification(run.begun.rod, run.begun.load)
    fresh.restore(seen.memory())
    assert fresh.excess == seen.excess
    np.testing.assert_array_equal(fresh.logarithms, seen.logarithms)
