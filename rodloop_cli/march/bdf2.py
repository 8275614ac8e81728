"""The paper's time stepping (Appendix B): fixed-step BDF2 of position and of velocity, backward Euler at first.

Eq. (B.3) with a variable ratio of steps, so that a step on which Newton fails can be split and the last one can end
on time. On one-point boxes this is the paper's scheme.
"""

from collections.abc import Iterator

import numpy as np

from rodloop_cli.errors import ConvergenceError, SingularSystem
from rodloop_cli.march.predictor import Past, predict
from rodloop_cli.march.stages import REUSE_BELOW, Linearisation, StageModes, solve_stages
from rodloop_cli.march.state import State, Step
from rodloop_cli.march.work import Work
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import NODAL, Instant, Iterate, Motion

NEWTON_TARGET = 1e-10
"""Position error at which Newton stops: far below the scheme's own error, above round-off amplified by Δt⁻²."""

SMALLEST_SPLIT = 2.0**-10
"""Of the given step: how far a failing step is split before the run gives up."""

SAME = 1e-9
"""Lengths that differ by less, relatively, differ by round-off of the time."""

END = np.array([1.0])
SINGLE = StageModes(np.ones(1), np.ones((1, 1)), np.ones((1, 1)))


class FixedMarcher:
    """Steps of ``dt`` to ``t_end``, the last one shortened to end there; a step on which Newton fails is halved.

    state: where the loop is;  before: the state one step earlier;  last: the predictor's memory;  size: the next step;
    linearisation, contraction: Newton's, of the last step.
    """

    def __init__(self, state: State, t_end: float, dt: float, work: Work) -> None:
        self.t_end, self.dt, self.work = t_end, dt, work
        self.state = state
        self.before: State | None = None
        self.last: Past | None = None
        self.size = dt
        self.linearisation: Linearisation | None = None
        self.contraction = 1.0

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
            self.last = _memory(self.before, self.last, step)
            self.before, self.state = self.state, step.end
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
        length = size / weights[0]

        def renew(iterate: Iterate, trusted: bool) -> Linearisation:
            self.work.factorizations += 1
            return self.linearised(state.equations, length, iterate.instant(0, None if trusted else state.force))

        kept = self.linearisation if self._serves(length) else None
        guess = predict(state, self.last, END, size)
        try:
            solution, self.linearisation = solve_stages(state.equations, motion, guess, kept, renew, NEWTON_TARGET)
        except SingularSystem:
            solution = None
        if solution is None:
            self.linearisation = None
            return None
        self.work.newton_iterations += solution.iterations
        self.contraction = solution.contraction
        a, b, c = weights
        rates = (a * solution.unknowns + b * state.unknowns + c * before.unknowns) / size
        return Step(state, size, END, solution.unknowns, rates, solution.fields, solution.iterations, 0.0)

    def linearised(self, equations: BoxEquations, length: float, instant: Instant) -> Linearisation:
        """The factored system of a step whose derivative is 1/``length``. Raises SingularSystem."""
        return Linearisation(equations, SINGLE, length, instant)

    def _serves(self, length: float) -> bool:
        kept = self.linearisation
        return kept is not None and self.contraction < REUSE_BELOW and abs(kept.step / length - 1) < SAME

    def _formula(self, size: float) -> tuple[tuple[float, float, float], State]:
        """Weights (times 1/Δt) of now, the last and the second last state, and that state."""
        if self.before is None:
            return (1.0, -1.0, 0.0), self.state
        ratio = size / (self.state.time - self.before.time)
        return ((1 + 2 * ratio) / (1 + ratio), -(1 + ratio), ratio**2 / (1 + ratio)), self.before


def _memory(before: State | None, last: Past | None, step: Step) -> Past:
    """The last two steps as one, whose stages are their ends: the first guess is as good as the scheme then."""
    if before is None or last is None:
        return Past.of(step)
    start, end = step.start, step.end
    previous = last.size * float(np.diff(last.nodes, prepend=0.0)[-1])
    size = previous + step.size
    unknowns = np.stack([before.unknowns, start.unknowns, end.unknowns])
    return Past(size, np.array([previous / size, 1.0]), unknowns, np.stack([start.force, end.force], axis=1))


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
