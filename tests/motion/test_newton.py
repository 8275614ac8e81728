"""The stage equations under full Newton iterations: quadratic convergence, which a wrong derivative would spoil."""

from itertools import pairwise

import numpy as np
import pytest

from rodloop_cli.march.predictor import Guess
from rodloop_cli.march.stages import Linearisation, StageModes, solve_stages
from rodloop_cli.numerics.gauss import gauss_rule
from rodloop_cli.numerics.radau import radau_iia
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import NODAL, Instant, Load, Motion
from rodloop_cli.physics.rod import Mesh, Rod, Segment
from rodloop_cli.physics.whole_loop import LoopEquations
from rodloop_cli.statics import unloaded

ROD = Rod((Segment(0.4), Segment(0.6, 5.0, 3.0)))


def one_step(leading, zeta, size):
    """Equations, motion from rest with ``leading``/Δt as rate, and the start as guess."""
    mesh, rule = Mesh.on(ROD, (4, 4)), gauss_rule(3)
    equations = BoxEquations(mesh, rule, Load(6.0, zeta, 0.3))
    unknowns = unloaded(mesh, rule)[None]
    rate = leading / size
    position = equations.shape(unknowns)[1]
    return equations, Motion(np.array([[rate]]), -rate * position, np.zeros_like(position)), unknowns


def resting(unknowns):
    """A guess without forces."""
    stages, cells, size = unknowns.shape
    return Guess(unknowns, np.zeros((2, stages, cells, size - NODAL + 1)))


@pytest.mark.parametrize("zeta", [0.0, 2.0])
@pytest.mark.parametrize("leading", [1.0, 1.5], ids=["backward Euler", "BDF2"])
def test_one_stage_converges_quadratically(leading, zeta):
    size = 0.3
    equations, motion, unknowns = one_step(leading, zeta, size)
    modes = StageModes(np.array([leading + 0j]), np.ones((1, 1), complex), np.ones((1, 1), complex))
    sizes = []
    for _ in range(7):
        fields = equations.fields(unknowns, motion)
        linearisation = Linearisation(equations, modes, size, Instant.of_stage(fields, 0))
        correction = linearisation.correction(equations.residual(unknowns, fields))
        unknowns = unknowns + correction
        sizes.append(float(np.abs(correction).max()))
    assert sizes[-1] < 1e-9
    # Beyond round-off every correction is of the order of the square of the one before.
    quadratic = [new / old**2 for old, new in pairwise(sizes) if new > 1e-9 and old < 1]
    assert quadratic
    assert max(quadratic) < 50


@pytest.mark.parametrize("form", [BoxEquations, LoopEquations])
@pytest.mark.parametrize("zeta", [0.0, 2.0])
@pytest.mark.parametrize("stages", [3, 5])
def test_the_stages_of_radau_are_solved_together(stages, zeta, form):
    """The simplified iteration contracts well, and ends on a solution of the coupled equations."""
    method = radau_iia(stages)
    modes = StageModes(method.eigenvalues, method.to_modes, method.from_modes)
    for size in (0.05, 0.02):
        boxes, _, start = one_step(1.0, zeta, size)
        equations = form(boxes.mesh, boxes.rule, boxes.load)
        rates = method.inverse / size
        past = -rates.sum(axis=1)[None, :, None, None] * boxes.shape(start)[1]
        motion = Motion(rates, past, np.zeros_like(past))
        guess = resting(np.repeat(start, stages, axis=0))

        def renew(iterate, trusted, equations=equations, size=size):
            return Linearisation(equations, modes, size, iterate.instant(stages // 2, None))

        solution, _ = solve_stages(equations, motion, guess, None, renew, 1e-11)
        assert solution is not None
        assert solution.contraction < 0.3
        # Whatever the form, what comes out solves the equations of the boxes.
        fields = boxes.fields(solution.unknowns, motion)
        assert float(np.abs(boxes.residual(solution.unknowns, fields)).max()) < 1e-6
        for name in ("position", "velocity", "force", "moment", "theta"):
            np.testing.assert_allclose(getattr(solution.fields, name), getattr(fields, name), atol=1e-6)


def test_an_iteration_that_does_not_contract_says_so():
    equations, motion, start = one_step(1.0, 0.0, 0.3)
    modes = StageModes(np.array([1.0 + 0j]), np.ones((1, 1), complex), np.ones((1, 1), complex))

    def renew(iterate, trusted):
        return Linearisation(equations, modes, 0.3, iterate.instant(0, None))

    wild = start + np.random.default_rng(0).normal(scale=30.0, size=start.shape)
    solution, _ = solve_stages(equations, motion, resting(wild), None, renew, 1e-11)
    assert solution is None
