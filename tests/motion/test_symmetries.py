"""Changes of a case that change nothing in the motion, or change it in a known way."""

from dataclasses import replace
from math import cos, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from rodloop_cli import Case, simulate
from rodloop_cli.march.loop import Marcher
from rodloop_cli.march.radau import started
from rodloop_cli.march.refine import Refiner
from rodloop_cli.march.state import State
from rodloop_cli.march.work import Work
from rodloop_cli.physics.closure import turned
from rodloop_cli.physics.equations import Load, X, Y
from rodloop_cli.physics.rod import Rod, Segment
from rodloop_cli.simulation import Run
from rodloop_cli.simulation import start as starting

TOL = 1e-5
FEW = 5 * TOL
"""Two runs of one motion may differ by the errors of both."""

POINTS = 40
# Only where the stiffness is the same all round: elsewhere waves make a kink, whose energy no mesh resolves.
WAVES = ((2, 0.02, 0.3), (3, 0.01, 1.1))
ENERGIES = ("bending_energy", "surface_energy", "kinetic_energy", "dissipated_energy")
DENSE = ((0.25, 1.0, 1.0), (0.25, 1.0, 3.0), (0.5, 1.0, 1.0))
THREE = ((0.25, 1.0, 1.0), (0.25, 5.0, 3.0), (0.5, 1.0, 1.0))


def perturbation(waves):
    return [{"mode": mode, "amplitude": amplitude, "phase": phase} for mode, amplitude, phase in waves]


def segments(pieces):
    return [{"fraction": f, "stiffness": b, "density": d} for f, b, d in pieces]


def run(**case):
    return simulate(Case(**({"tol": TOL, "snapshots": 6, "output_points": POINTS, "p": 3.8, "t_end": 1.0} | case)))


def positions(dataset):
    """(2, T, S)."""
    return np.stack([dataset.x.values, dataset.y.values])


def rotation(angle):
    return np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])


def assert_same_energies(dataset, expected, scale=1.0):
    """To the tolerance of positions, and by what both runs say that they gained or lost."""
    size = max(float(np.ptp(expected[name].values)) for name in ENERGIES)
    own = sum(float(np.abs(run.energy_residual.values).max()) / of for run, of in ((dataset, scale), (expected, 1.0)))
    for name in ENERGIES:
        np.testing.assert_allclose(
            dataset[name].values / scale, expected[name].values, atol=FEW * max(1.0, size) + own, err_msg=name
        )


LOOPS = {
    "homogeneous": {"perturbation": perturbation(WAVES), "t_end": 2.0},
    "three densities": {"segments": segments(DENSE), "perturbation": perturbation(WAVES)},
    "three segments": {"segments": segments(THREE)},
    "in a film that drags": {"stiffness_ratio": 5.0, "zeta_perp": 2.0, "gamma": 0.2},
    "inner film": {"density_ratio": 3.0, "p": -6.0, "perturbation": perturbation(WAVES)},
}


@pytest.mark.parametrize("loop", LOOPS.values(), ids=LOOPS.keys())
def test_where_the_loop_lies_does_not_matter(loop, monkeypatch):
    """The initial state turned and shifted moves as before, turned and shifted."""
    angle, shift = 0.7, np.array([3.0, -2.0])
    expected = run(**loop)
    build = starting.start

    def elsewhere(case):
        begun = build(case)
        unknowns = turned(begun.state.unknowns, angle)
        unknowns[:, X : Y + 1] += shift
        size = starting.STARTING_TIME * starting.fastest_time(begun.load, begun.rod)
        state, step = started(State.at_rest(begun.state.equations, unknowns), size)
        return replace(begun, state=state, step=step)

    monkeypatch.setattr("rodloop_cli.simulation.run.start", elsewhere)
    moved = run(**loop)
    back = np.einsum("ji,jts->its", rotation(angle), positions(moved) - shift[:, None, None])
    np.testing.assert_allclose(back, positions(expected), atol=FEW)
    np.testing.assert_allclose(moved.theta.values - angle, expected.theta.values, atol=10 * FEW)
    assert_same_energies(moved, expected)


@pytest.mark.parametrize("drag", [0.0, 2.0])
@pytest.mark.parametrize(("pieces", "waves"), [(DENSE, WAVES), (THREE, ())], ids=["density", "stiffness"])
def test_the_mirror_image_moves_as_the_mirror_image(drag, pieces, waves):
    """x -> -x takes s to 2π - s: the segments in the opposite order, the phases with the opposite sign."""
    loop = {"segments": segments(pieces), "perturbation": perturbation(waves), "zeta_perp": drag}
    opposite = perturbation([(mode, amplitude, -phase) for mode, amplitude, phase in waves])
    expected, mirrored = run(**loop), run(**loop | {"segments": segments(pieces[::-1]), "perturbation": opposite})
    image = positions(mirrored)[:, :, -np.arange(POINTS) % POINTS] * np.array([-1, 1])[:, None, None]
    np.testing.assert_allclose(image, positions(expected), atol=FEW)
    assert_same_energies(mirrored, expected)


def relabelled(stiffness, density, k, p, drag, t_end):
    """A case of two segments, and the same one counted from the second, whose material is then the unit of the other.

    Forces in B/R², time in R²√(ρA/B), drag in √(BρA)/R²; s' = s - 2πk, and the loop turned by as much. The waves leave
    the quarters of the loop in place, from one of which the new arclength is counted.
    """
    waves = ((2, 0.03, 0.0), (4, 0.01, 0.0)) if stiffness == 1 else ()
    first = {"stiffness_ratio": stiffness, "density_ratio": density, "k": k, "p": p, "zeta_perp": drag, "t_end": t_end}
    second = {
        "stiffness_ratio": 1 / stiffness,
        "density_ratio": 1 / density,
        "k": 1 - k,
        "p": p / stiffness,
        "zeta_perp": drag / sqrt(stiffness * density),
        "t_end": t_end * sqrt(stiffness / density),
        "perturbation": perturbation([(n, amplitude, phase - 2 * pi * k * n) for n, amplitude, phase in waves]),
    }
    return first | {"perturbation": perturbation(waves)}, second


@given(
    stiffness=st.sampled_from([0.2, 1.0, 3.0, 12.8]),
    density=st.sampled_from([0.3, 2.0, 5.0]),
    k=st.sampled_from([0.25, 0.5, 0.75]),
    p=st.floats(1, 8) | st.floats(-8, -1),
    drag=st.sampled_from([0.0, 1.0]),
)
@settings(max_examples=8, phases=[Phase.explicit, Phase.generate])  # shrinking a run costs minutes and says little
def test_which_segment_comes_first_does_not_matter(stiffness, density, k, p, drag):
    first, second = (run(**case) for case in relabelled(stiffness, density, k, p, drag, 0.5))
    np.testing.assert_allclose(first.t * sqrt(stiffness / density), second.t, rtol=1e-9)
    turned_back = np.einsum("ij,jts->its", rotation(2 * pi * k), positions(second))
    counted_back = np.roll(turned_back, round(k * POINTS), axis=2)
    np.testing.assert_allclose(counted_back, positions(first), atol=FEW)
    assert_same_energies(second, first, 1 / stiffness)


@pytest.mark.parametrize(
    ("pieces", "more"),
    [
        pytest.param(((1.0, 1.0, 1.0),), ((0.3, 1.0, 1.0), (0.7, 1.0, 1.0)), id="homogeneous"),
        pytest.param(THREE, (*THREE[:2], (0.2, 1.0, 1.0), (0.3, 1.0, 1.0)), id="the last of three"),
        pytest.param(THREE, (THREE[0], (0.1, 5.0, 3.0), (0.15, 5.0, 3.0), THREE[2]), id="the second of three"),
    ],
)
def test_a_junction_of_equal_materials_is_none(pieces, more):
    waves = WAVES if len(pieces) == 1 else ()
    expected, split = (run(segments=segments(s), perturbation=perturbation(waves)) for s in (pieces, more))
    np.testing.assert_allclose(positions(split), positions(expected), atol=FEW)
    assert_same_energies(split, expected)


@pytest.mark.parametrize(
    ("stiffer", "heavier"),
    [
        pytest.param(8.0, 2.0, id="twice the thickness"),
        pytest.param(1.0, 7.0, id="seven times the density"),
        pytest.param(30.0, 1.0, id="thirty times the stiffness"),
    ],
)
def test_units_do_not_matter(stiffer, heavier, monkeypatch):
    """B -> αB, ρ -> βρ, p -> αp, ζ -> √(αβ) ζ: the same motion, √(β/α) times as long, with α times the energy."""
    loop = {"segments": segments(THREE), "zeta_perp": 1.0, "t_end": 0.5}
    expected, slower = run(**loop), sqrt(heavier / stiffer)
    rod = Rod(tuple(Segment(f, stiffer * b, heavier * d) for f, b, d in THREE))
    load = Load(stiffer * 3.8, sqrt(stiffer * heavier), 0.5)
    monkeypatch.setattr(starting, "rod_of", lambda case: rod)
    monkeypatch.setattr(starting, "load_of", lambda case: load)
    scaled = run(**loop | {"t_end": 0.5 * slower})
    np.testing.assert_allclose(positions(scaled), positions(expected), atol=FEW)
    assert_same_energies(scaled, expected, stiffer)


@pytest.mark.parametrize(
    "loop",
    [
        pytest.param({"perturbation": perturbation(WAVES), "t_end": 1.5}, id="homogeneous"),
        pytest.param({"density_ratio": 5.0, "perturbation": perturbation(WAVES), "t_end": 1.5}, id="density"),
        pytest.param({"stiffness_ratio": 5.0, "t_end": 1.0}, id="stiffness"),
    ],
)
def test_an_undamped_motion_runs_back(loop):
    """With the velocities turned round at the end, the loop comes back to where it was at rest."""
    case = Case(tol=TOL, p=3.8, **loop)
    run = Run.of(case)
    there, begun = run.marcher, run.begun
    for step in there:
        end = step.end
    back = Marcher(
        replace(end, time=0.0, rates=-end.rates, velocity=-end.velocity), there.plan, Refiner(), begun.departure, Work()
    )
    for step in back:
        home = step.end
    start = begun.state
    assert float(np.abs(end.position).max()) > 1.01
    np.testing.assert_allclose(_at_nodes(home, start), start.unknowns[:, X : Y + 1], atol=10 * TOL)


def _at_nodes(state, start):
    """(n, 2): positions at the nodes of an earlier, coarser mesh."""
    kept = np.isin(state.equations.mesh.edges[:-1], start.equations.mesh.edges[:-1])
    return state.unknowns[kept, X : Y + 1]
