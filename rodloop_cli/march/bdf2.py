"""The paper's time stepping (Appendix B): fixed-step BDF2 of position and of velocity, backward Euler at first.

Eq. (B.3) with a variable ratio of steps, so that a step on which Newton fails can be split and the last one can end
on time. On one-point boxes this is the paper's scheme.
"""

from collections.abc import Iterator

import numpy as np

from rodloop_cli.errors import ConvergenceError, SingularSystem
from rodloop_cli.march.predictor import Past, predict
from rodloop_cli.march.stages import Linearisation, StageModes, solve_stages
from rodloop_cli.march.state import State, Step
from rodloop_cli.march.work import Work
from rodloop_cli.physics.equations import NODAL, Iterate, Motion

NEWTON_TARGET = 1e-10
"""Position error at which Newton stops: far below the scheme's own error, above round-off amplified by Δt⁻²."""

SMALLEST_SPLIT = 2.0**-10
"""Of the given step: how far a failing step is split before the run gives up."""

END = np.array([1.0])
SINGLE = np.ones((1, 1), dtype=complex)


class FixedMarcher:
    """Steps of ``dt`` to ``t_end``, the last one shortened to end there; a step on which Newton fails is halved.

    state: where the loop is;  before: the state one step earlier;  last: the predictor's memory;  size: the next step.
    """

    def __init__(self, state: State, t_end: float, dt: float, work: Work) -> None:
        self.t_end, self.dt, self.work = t_end, dt, work
        self.state = state
        self.before: State | None = None
        self.last: Past | None = None
        self.size = dt

    def __iter__(self) -> Iterator[Step]:
        """Steps up to ``t_end``. Raises ConvergenceError when splitting a step does not help."""
        while self.t_end - self.state.time > 1e-9 * self.dt:
            remaining = self.t_end - self.state.time
            size = remaining if self.size > remaining * (1 - 1e-9) else self.size
            step = self._step(size)
            if step is None:
                self._split(size)
                continue
            self.work.steps += 1
            self.before, self.state, self.last = self.state, step.end, Past.of(step)
            self.size = min(self.dt, 2 * size)
            yield step

    def _split(self, size: float) -> None:
        self.work.newton_failures += 1
        self.size = size / 2
        if self.size < SMALLEST_SPLIT * self.dt:
            raise ConvergenceError(
                f"no convergence at t = {self.state.time:.6g}: Newton's iteration failed down to a step of "
                f"{self.size:.1e}; try a smaller dt, more grid points (N) or scheme: radau"
            )

    def _step(self, size: float) -> Step | None:
        state = self.state
        weights, before = self._formula(size)
        motion = _motion(weights, size, state, before)
        modes = StageModes(np.array([weights[0] + 0j]), SINGLE, SINGLE)

        def renew(iterate: Iterate, trusted: bool) -> Linearisation:
            self.work.factorizations += 1
            instant = iterate.instant(0, None if trusted else state.force)
            return Linearisation(state.equations, modes, size, instant)

        guess = predict(state, self.last, END, size)
        try:
            solution, _ = solve_stages(state.equations, motion, guess, None, renew, NEWTON_TARGET)
        except SingularSystem:
            return None
        if solution is None:
            return None
        self.work.newton_iterations += solution.iterations
        a, b, c = weights
        rates = (a * solution.unknowns + b * state.unknowns + c * before.unknowns) / size
        return Step(state, size, END, solution.unknowns, rates, solution.fields, solution.iterations, 0.0)

    def _formula(self, size: float) -> tuple[tuple[float, float, float], State]:
        """Weights (times 1/Δt) of now, the last and the second last state, and that state."""
        if self.before is None:
            return (1.0, -1.0, 0.0), self.state
        ratio = size / (self.state.time - self.before.time)
        return ((1 + 2 * ratio) / (1 + ratio), -(1 + ratio), ratio**2 / (1 + ratio)), self.before


def _motion(weights: tuple[float, float, float], size: float, state: State, before: State) -> Motion:
    a, b, c = weights
    motion = Motion(
        np.array([[a / size]]),
        ((b * state.position + c * before.position) / size)[:, None],
        ((b * state.velocity + c * before.velocity) / size)[:, None],
    )
    if not state.equations.load.rotary_inertia:
        return motion
    spin = (b * state.unknowns + c * before.unknowns)[None, :, NODAL:] / size
    spin_rate = (b * state.rates + c * before.rates)[None, :, NODAL:] / size
    return motion._replace(spin_past=spin, spin_rate_past=spin_rate)
