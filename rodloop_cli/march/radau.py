"""One step of Radau IIA on the constrained equations, with an embedded estimate of the position error.

With X the stage positions, U = (A^-1/Δt)(X - x0) and W = (A^-1/Δt)(U - u0): the constraint of inextensibility enters
as part of the box system, never differentiated.
"""

from dataclasses import replace
from functools import cache

import numpy as np

from rodloop_cli.errors import SingularSystem
from rodloop_cli.march.newton import Newton
from rodloop_cli.march.predictor import Past, predict
from rodloop_cli.march.stages import Equations, StageModes
from rodloop_cli.march.state import State, Step
from rodloop_cli.march.work import Work
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.numerics.radau import RadauIIA, radau_iia
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import NODAL, Fields, Motion
from rodloop_cli.physics.whole_loop import LoopEquations

MOST_FULL = 64
"""Gauss points up to which one full matrix is faster than boxes."""

STARTING_ACCURACY = 1e-8
STARTING_LENGTHS = (1.0, 10.0, 100.0, 1000.0)
"""Tried in turn, in units of the negligible length asked for: the last is a tenth of the fastest time of the motion."""

ITERATION_ERROR = 0.003
"""Newton's share of the position error allowed in a step. Its error in velocities, and so in energies, is that in
positions over the step."""

LEAST_TARGET = 3e-14
"""Position error below which Newton is not asked to go: round-off."""


class RadauStepper:
    """Makes steps; ``newton`` remembers the linearisation and how fast it contracted, which only speeds it up."""

    def __init__(self, stages: int, work: Work, iteration_error: float = ITERATION_ERROR) -> None:
        self.method = radau_iia(stages)
        self.newton = Newton(_modes(stages), work)
        self._iteration_error = iteration_error
        self._boxes: BoxEquations | None = None
        self._solved: Equations

    def step(
        self, state: State, last: Past | None, size: float, allowance: float, most_target: float = np.inf
    ) -> Step | None:
        """A step of length ``size`` whose ``error`` is measured against ``allowance``; None if Newton fails.

        ``most_target`` bounds Newton's share of it.
        """
        method, equations = self.method, self.form(state.equations)
        motion = _motion(method, state, size)
        guess = predict(state, last, method.nodes, size)
        target = max(LEAST_TARGET, min(most_target, self._iteration_error * allowance))
        solution = self.newton.solve(equations, motion, guess, size, state.force, target)
        if solution is None:
            return None
        gained = solution.unknowns - state.unknowns
        rates = (motion.rates @ gained.reshape(method.stages, -1)).reshape(gained.shape)
        error = self._error(equations, state, solution.fields, size) / allowance
        return Step(state, size, method.nodes, solution.unknowns, rates, solution.fields, solution.iterations, error)

    def form(self, equations: BoxEquations) -> Equations:
        """The equations in the form that is solved faster."""
        if self._boxes is not equations:
            self._boxes = self._solved = equations
            if equations.mesh.cells * equations.rule.m <= MOST_FULL:
                self._solved = LoopEquations(equations.mesh, equations.rule, equations.load)
        return self._solved

    def _error(self, equations: Equations, state: State, fields: Fields, size: float) -> float:
        """The embedded estimate, in positions.

        The embedded formula needs the acceleration a0 at the start but not the force: the constraint absorbs it. What
        is left is the real box system, already factored, under the force density -ρ[λ r_X + Σ e z_U/Δt + a0], r_X = Σ
        e z_X/Δt + u0.
        """
        linearisation = self.newton.linearisation
        assert linearisation is not None
        weights, rate = self.method.embedded / size, self.method.eigenvalues[0].real / size
        total = float(weights.sum())
        push = _weighted(rate * weights, fields.position) - (rate * total) * state.position
        push += _weighted(weights, fields.velocity) + (rate - total) * state.velocity
        push += state.acceleration
        push *= -state.equations.mesh.density[:, None]
        cosine, sine = fields.tangent[:, -1]
        correction = linearisation.systems.solve_real(equations.load_response(cosine, sine, push[..., :-1]))
        return float(np.abs(equations.displacement(cosine, sine, correction)).max())


def _weighted(weights: Array, stages: Array) -> Array:
    """(2, n, m + 1): the sum of values at the stages (2, s, n, m + 1)."""
    values: Array = (weights @ stages.reshape(2, len(weights), -1)).reshape(2, *stages.shape[2:])
    return values


@cache
def _modes(stages: int) -> StageModes:
    method = radau_iia(stages)
    return StageModes(method.eigenvalues, method.to_modes, method.from_modes)


def _motion(method: RadauIIA, state: State, size: float) -> Motion:
    rates = method.inverse / size
    past = -rates.sum(axis=1)[:, None, None]
    motion = Motion(rates, past * state.position[:, None], past * state.velocity[:, None])
    if not state.equations.load.rotary_inertia:
        return motion
    return motion._replace(spin_past=past * state.unknowns[:, NODAL:], spin_rate_past=past * state.rates[:, NODAL:])


def started(state: State, size: float) -> tuple[State, Step]:
    """The state at rest with the acceleration and the forces that hold just after the load is switched on.

    They are those of one backward Euler step of negligible length ``size``, or of a longer one where Newton fails: the
    shorter the step, the shorter the waves that leave a jump of the moment, and the cells are what they are. The step
    is returned too. Raises SingularSystem if none can be solved.
    """
    for longer in STARTING_LENGTHS:
        step = RadauStepper(1, Work()).step(state, None, longer * size, STARTING_ACCURACY)
        if step is not None:
            return replace(state, acceleration=step.end.acceleration, force=step.end.force), step
    raise SingularSystem(
        "the equations just after the load is switched on cannot be solved; "
        "try a smaller perturbation, a smaller load or contrast, or more cells (N)"
    )
