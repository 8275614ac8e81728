"""The equations of the whole loop against those of the boxes, and their matrix against differences."""

import numpy as np
import pytest

from rodloop_cli.errors import SingularSystem
from rodloop_cli.numerics.full import FullSystems
from rodloop_cli.numerics.gauss import gauss_rule
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import NODAL, Instant, Load, Motion
from rodloop_cli.physics.rod import Mesh, Rod, Segment
from rodloop_cli.physics.whole_loop import LoopEquations

MESH = Mesh.on(Rod((Segment(0.3), Segment(0.5, 5.0, 2.0), Segment(0.2, 0.4, 0.1))), (2, 3, 1))
RULE = gauss_rule(4)
LOADS = {
    "film": Load(3.8),
    "isotropic drag": Load(-2.0, 1.3, 1.0),
    "drag": Load(3.8, 1.3, 0.4),
    "rotary inertia": Load(3.8, rotary_inertia=0.05),
    "rotary inertia and drag": Load(3.8, 0.7, 0.2, 0.05),
}


@pytest.fixture(params=LOADS)
def loop(request):
    return LoopEquations(MESH, RULE, LOADS[request.param])


@pytest.fixture
def dice():
    return np.random.default_rng(3)


def boxes_of(loop):
    return BoxEquations(MESH, RULE, loop.load)


def anywhere(dice, rates):
    """Random unknowns of the boxes, random forces and a random past of as many stages as there are ``rates``."""
    stages, inside = len(rates), (len(rates), MESH.cells, RULE.m)
    past = dice.normal(size=(2, 2, stages, MESH.cells, RULE.m + 1))
    force = dice.normal(size=past.shape[1:])
    return dice.normal(size=(*inside[:2], NODAL + RULE.m)), force, Motion(rates, *past, *dice.normal(size=(2, *inside)))


def moved(iterate, instant, correction):
    """The iterate once its forces have come into balance and it has then been corrected."""
    iterate.residual(instant)
    iterate.correct(np.zeros_like(correction))
    iterate.residual(instant)
    iterate.correct(correction)
    return iterate


def settled(loop, unknowns, force, motion):
    """What `moved` comes to without a correction: instant of stage 0, unknowns of the boxes, fields."""
    iterate = loop.iterate(unknowns, force, motion)
    instant = iterate.instant(0, None)
    moved(iterate, instant, np.zeros((len(unknowns), loop.size)))
    return iterate.instant(0, None), *iterate.solution()


def test_the_fields_are_those_of_the_boxes(loop, dice):
    unknowns, force, motion = anywhere(dice, dice.normal(size=(3, 3)))
    _, stored, fields = settled(loop, unknowns, force, motion)
    for one, other in zip(fields, boxes_of(loop).fields(stored, motion), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)
    np.testing.assert_array_equal(stored[:, 0, :NODAL], unknowns[:, 0, :NODAL])
    np.testing.assert_array_equal(stored[..., NODAL:], unknowns[..., NODAL:])


def test_what_is_left_is_what_the_last_box_misses(loop, dice):
    unknowns, force, motion = anywhere(dice, np.eye(2))
    instant, stored, fields = settled(loop, unknowns, force, motion)
    missed = boxes_of(loop).residual(stored, fields)
    left = loop.iterate(stored, fields.force, motion).residual(instant)
    np.testing.assert_allclose(missed[:, :-1, :NODAL], 0, atol=1e-12)
    np.testing.assert_allclose(missed[:, -1, :NODAL], left[:, :NODAL], atol=1e-12)
    np.testing.assert_allclose(missed[..., NODAL:].reshape(2, -1), left[:, NODAL:], atol=1e-12)


def test_an_instant_is_that_of_the_fields(loop, dice):
    """Their own, or with forces that are given."""
    unknowns, force, motion = anywhere(dice, np.eye(2))
    _, stored, fields = settled(loop, unknowns, force, motion)
    iterate = loop.iterate(stored, fields.force, motion)
    for given in (None, force[:, 1]):
        for found, expected in zip(iterate.instant(1, given), Instant.of_stage(fields, 1, given), strict=True):
            np.testing.assert_allclose(found, expected, atol=1e-12)


def test_the_matrix_is_minus_the_derivative_of_the_residual(loop, dice):
    rate, step = 1.7, 1e-6
    unknowns, force, motion = anywhere(dice, np.array([[rate]]))
    instant, stored, fields = settled(loop, unknowns, force, motion)
    parts = loop.linearise(*instant)
    matrix = sum(part * rate**power for part, power in zip(parts, (0, 2, 1), strict=False))

    def residual(correction):
        """Of the unknowns alone: the forces are those that balance them, not lifted."""
        iterate = loop.iterate(stored, fields.force, motion)
        iterate.residual(instant)
        iterate.correct(correction[None])
        now = iterate.solution()[0]
        balanced = settled(loop, now, fields.force, motion)[2].force
        return loop.iterate(now, balanced, motion).residual(instant)[0]

    for column, unit in enumerate(np.eye(loop.size)):
        slope = (residual(step * unit) - residual(-step * unit)) / (2 * step)
        np.testing.assert_allclose(matrix[:, column], -slope, atol=1e-7, err_msg=str(column))


def test_a_correction_changes_the_fields_as_its_linear_response_says(loop, dice):
    """Lifted forces, moments and angles after a small correction are those of the moved unknowns, to second order."""
    unknowns, force, motion = anywhere(dice, np.array([[1.7]]))
    instant, stored, fields = settled(loop, unknowns, force, motion)
    size = 1e-6
    correction = size * dice.normal(size=(1, loop.size))
    if loop.load.zeta_perp:  # the drag's change with the direction of the rod is left to the next iteration
        correction[:, NODAL:] = 0
    iterate = moved(loop.iterate(stored, fields.force, motion), instant, correction)
    after_unknowns, after = iterate.solution()
    for one, other in zip(after, boxes_of(loop).fields(after_unknowns, motion), strict=True):
        np.testing.assert_allclose(one, other, atol=1e4 * size**2)


def test_how_far_a_correction_moves_the_rod(loop, dice):
    unknowns, force, motion = anywhere(dice, np.array([[1.7]]))
    instant, stored, fields = settled(loop, unknowns, force, motion)
    iterate = loop.iterate(stored, fields.force, motion)
    iterate.residual(instant)
    size = iterate.correct(dice.normal(size=(1, loop.size)))
    assert size == pytest.approx(np.abs(iterate.solution()[1].position - fields.position).max(), rel=1e-12)


def test_forces_that_miss_their_balance_push_along_the_tangent_of_the_instant(loop, dice):
    """A lifted force F and the balanced one B bend the rod by F·n + (B - F)·n0, n0 the normal of the instant."""
    unknowns, force, motion = anywhere(dice, np.array([[1.7]]))
    _, stored, fields = settled(loop, unknowns, force, motion)
    instant = Instant(*dice.normal(size=(2, MESH.cells, RULE.m)), *dice.normal(size=(2, 2, MESH.cells, RULE.m)))
    missing = 1e-3 * dice.normal(size=force.shape)
    left = loop.iterate(stored, fields.force - missing, motion).residual(instant)
    balanced = loop.iterate(stored, fields.force, motion).residual(instant)
    turn = np.stack([instant.sine, -instant.cosine]) - np.stack([fields.sine[0], -fields.cosine[0]])
    shear = (missing[:, 0, :, :-1] * turn).sum(axis=0)
    expected = loop.turning(np.zeros((1, loop.size)), shear[None])[1][..., :-1]
    np.testing.assert_allclose((left - balanced)[:, NODAL:], expected.reshape(1, -1), atol=1e-12)


def test_an_extra_force_and_a_displacement_are_those_of_the_boxes(dice):
    angle, density = dice.normal(size=(MESH.cells, RULE.m)), dice.normal(size=(2, MESH.cells, RULE.m))
    tangent = np.cos(angle), np.sin(angle)
    loop = LoopEquations(MESH, RULE, Load(3.8))
    matrix = loop.linearise(*tangent, density, density)
    pushed = np.linalg.solve(matrix[0] + matrix[1], loop.load_response(*tangent, density))
    boxes = BoxEquations(MESH, RULE, Load(3.8))
    systems = boxes.factored(np.ones(1, complex), *tangent, density, density)
    pushed_boxes = systems.solve_real(boxes.load_response(*tangent, density))
    there = boxes.displacement(*tangent, pushed_boxes)
    np.testing.assert_allclose(loop.displacement(*tangent, pushed), there.reshape(2, -1), atol=1e-9)


def test_full_systems_solve_their_equations(dice):
    parts, rates = dice.normal(size=(3, 7, 7)), np.array([2.0, 1 + 2j, 0.3 - 1j])
    right = dice.normal(size=(3, 7)) + 1j * dice.normal(size=(3, 7))
    systems = FullSystems(parts, rates)
    right[0].imag = 0
    solved = systems.solve(right)
    for rate, x, b in zip(rates, solved, right, strict=True):
        np.testing.assert_allclose((parts[0] + rate**2 * parts[1] + rate * parts[2]) @ x, b, atol=1e-11)
    np.testing.assert_allclose(systems.solve_real(right[0].real), solved[0].real, atol=1e-13)
    with pytest.raises(SingularSystem):
        FullSystems(np.zeros((2, 3, 3)), rates)
