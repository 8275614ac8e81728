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
    "rotary inertia": Load(3.8, 0.7, 0.2, 0.05),
}


@pytest.fixture(params=LOADS)
def loop(request):
    return LoopEquations(MESH, RULE, LOADS[request.param])


@pytest.fixture
def dice():
    return np.random.default_rng(3)


def anywhere(loop, dice, rates):
    """Random unknowns and a random past of as many stages as there are ``rates``."""
    stages, inside = len(rates), (len(rates), MESH.cells, RULE.m)
    past = dice.normal(size=(2, 2, stages, MESH.cells, RULE.m + 1))
    spins = dice.normal(size=(2, *inside))
    return dice.normal(size=(stages, loop.size)), Motion(rates, *past, *spins)


def test_the_fields_are_those_of_the_boxes(loop, dice):
    unknowns, motion = anywhere(loop, dice, dice.normal(size=(3, 3)))
    fields = loop.fields(unknowns, motion)
    boxes, stored = BoxEquations(MESH, RULE, loop.load), loop.expanded(unknowns, fields)
    for one, other in zip(fields, boxes.fields(stored, motion), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)
    np.testing.assert_array_equal(loop.compressed(stored), unknowns)


def test_what_is_left_is_what_the_last_box_misses(loop, dice):
    unknowns, motion = anywhere(loop, dice, np.eye(2))
    fields = loop.fields(unknowns, motion)
    boxes, stored = BoxEquations(MESH, RULE, loop.load), loop.expanded(unknowns, fields)
    missed, left = boxes.residual(stored, fields), loop.residual(unknowns, fields)
    np.testing.assert_allclose(missed[:, :-1, :NODAL], 0, atol=1e-12)
    np.testing.assert_allclose(missed[:, -1, :NODAL], left[:, :NODAL], atol=1e-12)
    np.testing.assert_allclose(missed[..., NODAL:].reshape(2, -1), left[:, NODAL:], atol=1e-12)


def test_the_matrix_is_minus_the_derivative_of_the_residual(loop, dice):
    rate, step = 1.7, 1e-6
    unknowns, motion = anywhere(loop, dice, np.array([[rate]]))
    parts = loop.linearise(*Instant.of_stage(loop.fields(unknowns, motion), 0))
    matrix = sum(part * rate**power for part, power in zip(parts, (0, 2, 1), strict=False))

    def residual(moved):
        return loop.residual(moved, loop.fields(moved, motion))[0]

    for column, unit in enumerate(np.eye(loop.size)):
        slope = (residual(unknowns + step * unit) - residual(unknowns - step * unit)) / (2 * step)
        np.testing.assert_allclose(matrix[:, column], -slope, atol=1e-7, err_msg=str(column))


def test_a_correction_changes_the_fields_as_its_linear_response_says(loop, dice):
    """Lifted forces, moments and angles after a small correction are those of the moved unknowns, to second order."""
    unknowns, motion = anywhere(loop, dice, np.array([[1.7]]))
    fields = loop.fields(unknowns, motion)
    instant = Instant.of_stage(fields, 0)
    size = 1e-6
    correction = size * dice.normal(size=unknowns.shape)
    if loop.load.zeta_perp:  # the drag's change with the direction of the rod is left to the next iteration
        correction[:, NODAL:] = 0
    after = loop.corrected(fields, unknowns + correction, correction, motion, instant)
    after = loop.finished(fields, after, correction, motion, instant)
    for one, other in zip(after, loop.fields(unknowns + correction, motion), strict=True):
        np.testing.assert_allclose(one, other, atol=1e4 * size**2)


def test_forces_that_are_in_balance_are_left_alone(loop, dice):
    unknowns, motion = anywhere(loop, dice, np.array([[1.7]]))
    fields = loop.fields(unknowns, motion)
    again = loop.integrated(
        unknowns, fields, motion, Instant(*dice.normal(size=(2, 1, 1)), *dice.normal(size=(2, 2, 1)))
    )
    for one, other in zip(again, fields, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)


def test_an_extra_force_and_a_displacement_are_those_of_the_boxes(dice):
    angle, density = dice.normal(size=(MESH.cells, RULE.m)), dice.normal(size=(2, MESH.cells, RULE.m))
    tangent = np.cos(angle), np.sin(angle)
    loop = LoopEquations(MESH, RULE, Load(3.8))
    matrix = loop.linearise(*tangent, density, density)
    pushed = np.linalg.solve(matrix[0] + matrix[1], loop.load_response(*tangent, density))
    boxes = BoxEquations(MESH, RULE, Load(3.8))
    systems = boxes.factored(np.ones(1, complex), *tangent, density, density)
    pushed_boxes = systems.solve_real(boxes.load_response(*tangent, density))
    np.testing.assert_allclose(
        loop.displacement(*tangent, pushed), boxes.displacement(*tangent, pushed_boxes), atol=1e-9
    )


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
