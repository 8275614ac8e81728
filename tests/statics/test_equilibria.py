"""Equilibria on the boxes, and branches of them."""

import numpy as np
import pytest

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.clearance import crossing_indicator
from rodloop_cli.physics.closure import turned
from rodloop_cli.physics.equations import NODAL, Load
from rodloop_cli.physics.rod import LENGTH, Rod, Segment
from rodloop_cli.stability.threshold import classified, find_threshold, neutral_directions, outline, touches_itself
from rodloop_cli.stability.watch import Watched, follow_watched, interpolated
from rodloop_cli.statics import relax
from rodloop_cli.statics.branch import BranchPoint, follow, to_load
from rodloop_cli.statics.loaded import Loaded, at_zero_load, loaded_circle, mesh_of, upright
from rodloop_cli.statics.newton import FixedArea, FixedLoad, solve
from rodloop_cli.statics.switching import crossing_branches


def two(ratio, k=0.5):
    return Rod((Segment(k), Segment(1 - k, ratio)))


@pytest.mark.parametrize(("ratio", "energy", "area"), [(5, 51.96382, 0.07731161), (12.8, 96.84788, 0.06993582)])
def test_the_unloaded_loop(ratio, energy, area):
    loop = at_zero_load(two(ratio), 12)
    assert loop.bending_energy * LENGTH == pytest.approx(energy, abs=6e-6)
    assert loop.area / LENGTH**2 == pytest.approx(area, abs=6e-9)


def test_the_circle_is_an_equilibrium_at_any_load():
    loop = loaded_circle(Rod(), 16.0, 12)
    assert np.abs(loop.residual).max() < 1e-11
    assert loop.area == pytest.approx(np.pi, abs=1e-12)


def test_following_the_branch_and_relaxing_the_energy_meet():
    loop = to_load(at_zero_load(two(5), 12), 3.8)
    bent = 0.02 * np.sin(np.arange(loop.unknowns.size)).reshape(loop.unknowns.shape)
    relaxed = relax(loop.equations, loop.unknowns + bent)
    assert Loaded(loop.equations, relaxed).area == pytest.approx(loop.area, abs=1e-10)
    assert np.abs(loop.residual).max() < 1e-12


def test_the_pins_change_no_equilibrium():
    loop = to_load(at_zero_load(two(5), 12), 3.8)
    away = turned(loop.unknowns, 0.7)
    away[:, :2] += (3.0, -1.0)
    solved = solve(Loaded(loop.equations, away).moved(np.zeros_like(away), 0.1), FixedLoad(3.9)).loop
    straight = solve(loop.moved(np.zeros_like(away), 0.1), FixedLoad(3.9)).loop
    assert solved.area == pytest.approx(straight.area, abs=1e-11)
    back = upright(solved).unknowns[:, NODAL:]
    assert back == pytest.approx(upright(straight).unknowns[:, NODAL:], abs=1e-10)


def test_the_energy_follows_from_the_work_of_the_load():
    """Along a branch dEb = -p dA."""
    points = []
    for point in follow(BranchPoint.first(at_zero_load(two(5), 12)), longest=0.05):
        points.append((point.loop.p, point.loop.area, point.loop.bending_energy))
        if point.loop.p > 4:
            break
    p, area, energy = np.array(points).T
    work = -np.cumsum((p[1:] + p[:-1]) / 2 * np.diff(area))
    assert energy[1:] - energy[0] == pytest.approx(work, abs=2e-3 * work[-1])


def test_points_of_a_branch_do_not_depend_on_the_cells():
    areas = [to_load(at_zero_load(two(5, 0.3), cells), 6.0).area for cells in (10, 24)]
    assert areas[0] == pytest.approx(areas[1], abs=1e-8)


def test_the_area_is_held_by_its_load():
    start = to_load(at_zero_load(two(5), 12), 3.0)
    held = solve(start, FixedArea(start.area - 0.1)).loop
    assert held.area == pytest.approx(start.area - 0.1, abs=1e-12)
    assert to_load(start, held.p).area == pytest.approx(held.area, abs=1e-9)


def test_too_far_is_said():
    mesh, rule = mesh_of(two(5), 12)
    start = at_zero_load(two(5), 12)
    astray = Loaded(BoxEquations(mesh, rule, Load(500.0)), start.unknowns)
    with pytest.raises(ConvergenceError, match="no equilibrium found near p = 500"):
        solve(astray, FixedLoad(500.0))


# -- the buckled circle


@pytest.fixture(scope="module")
def halves():
    threshold = find_threshold(at_zero_load(Rod(), 12), 10.0).threshold
    return threshold, crossing_branches(threshold.loop, neutral_directions(threshold.loop))


def test_the_circle_buckles_at_three(halves):
    threshold, _ = halves
    assert (threshold.p, threshold.kind) == (pytest.approx(3.0, abs=1e-9), "bifurcation")


@pytest.mark.parametrize("half", [0, 1])
def test_both_orientations_of_the_buckled_loop(halves, half):
    loop = halves[1][half].step(0.2)[0].loop
    width, height = np.ptp(outline(loop), axis=1)
    assert loop.p > 3
    assert np.abs(loop.residual).max() < 1e-11
    other = halves[1][1 - half].step(0.2)[0].loop
    assert (width, height) == pytest.approx(np.ptp(outline(other), axis=1)[::-1], abs=1e-3)
    assert loop.area == pytest.approx(other.area, abs=1e-7)


def test_the_buckled_loop_touches_itself_at_5_247(halves):
    """Flaherty, Keller & Rubinow, SIAM J. Appl. Math. 23 (1972) 446: opposite sides meet at p = 5.247."""
    before = halves[1][0].step(0.1)[0]
    for point in follow(before):
        if touches_itself(point.loop):
            break
        before = point
    near, past = (crossing_indicator(*outline(p.loop)) for p in (before, point))
    contact = before.loop.p + near / (near - past) * (point.loop.p - before.loop.p)
    assert contact == pytest.approx(5.247, abs=1e-2)


# -- an imperfect bifurcation


def test_the_detached_branch_of_a_nearly_uniform_loop_turns_back_in_a_fold():
    """Of the two orientations the one that the contrast does not favour ends in a fold above p = 3."""
    rod = two(1.1)
    start = to_load(at_zero_load(rod, 12), 4.5)
    mesh = start.equations.mesh
    s = mesh.points(start.equations.rule.points)
    guess = start.unknowns.copy()
    guess[:, NODAL:] = 2 * s - start.unknowns[:, NODAL:]
    other = Loaded(start.equations, relax(start.equations, guess))
    if abs(other.area - start.area) < 1e-3:
        pytest.skip("the relaxation fell back to the favoured orientation")
    before = Watched(BranchPoint.first(other, rising=False))
    for here in follow_watched(before):
        if here.point.tangent.p > 0:
            break
        before = here
    fold = interpolated(before, here, before.point.tangent.p, here.point.tangent.p)
    assert 3.0 < fold.p < 4.5
    assert classified(fold).kind == "fold"
