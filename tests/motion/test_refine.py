"""Carrying a state over to a finer mesh."""

from functools import cache

import numpy as np
import pytest

from rodloop_cli import Case, simulate
from rodloop_cli.march.refine import Finer, unresolved
from rodloop_cli.physics.closure import Closure
from rodloop_cli.physics.energies import Quadrature
from rodloop_cli.physics.equations import FX, MOMENT, NODAL, X, Y
from rodloop_cli.physics.rod import Mesh, Rod, Segment
from rodloop_cli.simulation import Run

FLAGS = pytest.mark.parametrize("flags", ["one", "alternate", "all"])


@cache
def moving():
    """A state in the middle of a motion, away from the origin's symmetry."""
    run = Run.of(Case(p=3.8, density_ratio=3.0, perturbation=[{"mode": 2, "amplitude": 0.05}], t_end=2.0, N=8))
    for step in run.marcher:
        state = step.end
    return state


def finer(state, flags):
    cells = np.arange(state.equations.mesh.cells)
    chosen = {"one": cells == 2, "alternate": cells % 2 == 0, "all": cells >= 0}
    return Finer(state.equations, chosen[flags])


@FLAGS
def test_the_loop_stays_closed_and_inextensible(flags):
    """Positions are the integral of the tangent, velocities that of its rate, round the loop and back."""
    state = finer(moving(), flags).transfer(moving())
    equations = state.equations
    tangent, position = equations.shape(state.unknowns[None])
    np.testing.assert_allclose(position[:, 0], state.position, atol=1e-13)
    np.testing.assert_allclose(position[:, 0, -1, -1], state.unknowns[0, X : Y + 1], atol=1e-13)
    turning = np.stack([-tangent[1, 0], tangent[0, 0]]) * state.rates[:, NODAL:] * equations.mesh.lengths[:, None]
    along = turning @ equations.rule.to_points_and_end + state.rates[:, X : Y + 1].T[..., None]
    np.testing.assert_allclose(along, state.velocity, atol=1e-13)
    np.testing.assert_allclose(along[:, -1, -1], state.rates[0, X : Y + 1], atol=1e-13)


@FLAGS
def test_the_centre_and_its_velocity_are_kept(flags):
    before = moving()
    after = finer(before, flags).transfer(before)
    for values in ("position", "velocity"):
        kept = Closure(before.equations).centre(getattr(before, values))
        np.testing.assert_allclose(Closure(after.equations).centre(getattr(after, values)), kept, atol=1e-6)


@FLAGS
def test_the_motion_is_kept_within_its_resolution(flags):
    before = moving()
    after = finer(before, flags).transfer(before)
    resolution = unresolved(before.equations, before.unknowns).max()
    old = np.isin(after.equations.mesh.edges[1:], before.equations.mesh.edges[1:])
    for values, scale in (("position", 1.0), ("velocity", 10.0), ("acceleration", 100.0), ("force", 100.0)):
        got, expected = getattr(after, values)[:, old, -1], getattr(before, values)[..., -1]
        np.testing.assert_allclose(got, expected, atol=20 * scale * max(resolution, 1e-9), err_msg=values)
    energies = [
        Quadrature(state.equations.mesh, state.equations.rule).kinetic(state.velocity[..., :-1])
        for state in (before, after)
    ]
    assert energies[0] == pytest.approx(energies[1], rel=1e-4)
    assert np.isfinite(after.unknowns[:, MOMENT : FX + 2]).all()


def test_cells_that_are_not_flagged_keep_their_angles():
    before = moving()
    cells = np.arange(before.equations.mesh.cells)
    after = Finer(before.equations, cells == 2).transfer(before)
    np.testing.assert_allclose(after.unknowns[:2, NODAL:], before.unknowns[:2, NODAL:], atol=1e-6)
    np.testing.assert_allclose(after.unknowns[4:, NODAL:], before.unknowns[3:, NODAL:], atol=1e-6)


def test_interpolation_is_exact_for_polynomials_of_the_cell_and_periodic():
    state = moving()
    change = finer(state, "alternate")
    for function in (np.cos, np.sin, lambda s: np.cos(2 * s)):
        old, new = (function(e.mesh.points(np.append(e.rule.points, 1.0))) for e in (state.equations, change.equations))
        np.testing.assert_allclose(change.interpolate(old), new, atol=1e-5)


def test_a_bisected_mesh_keeps_materials_and_junctions():
    rod = Rod((Segment(0.3), Segment(0.7, 5.0, 3.0)))
    mesh = Mesh.on(rod, (2, 3))
    fine = mesh.bisected(np.array([False, True, True, False, False]))
    np.testing.assert_allclose(fine.lengths.sum(), 2 * np.pi)
    assert fine.segment.tolist() == [0, 0, 0, 1, 1, 1, 1]
    assert fine.stiffness.tolist() == [1, 1, 1, 5, 5, 5, 5]
    assert fine.density.tolist() == [1, 1, 1, 3, 3, 3, 3]
    assert rod.ends[0] in fine.edges
    np.testing.assert_allclose(fine.lengths[1], mesh.lengths[1] / 2)
    assert set(mesh.edges) <= set(fine.edges)


def test_cells_too_long_for_the_first_waves_are_halved_in_time():
    """The velocities of the waves that leave the junctions were not resolved: 16 tol, and nothing to see at first."""
    case = {"p": 56.8, "stiffness_ratio": 0.334, "density_ratio": 0.143, "k": 0.768, "zeta_perp": 1.88, "t_end": 0.04}
    run, reference = (simulate(Case(**case, snapshots=9, output_points=64, tol=tol)) for tol in (1e-6, 1e-7))
    apart = np.hypot(run.x - reference.x, run.y - reference.y)
    assert float(apart.max()) < 2e-6
