"""The paper's time stepping (Appendix B): fixed-step BDF2 of position and of velocity, backward Euler at first.

Eq. (B.3) with a variable ratio of steps, so that a step on which Newton fails can be split and the last one can end
on time. On one-point boxes this is the paper's scheme.
"""

from collections.abc import Iterator

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.march.newton import Newton
from rodloop_cli.march.predictor import Past, predict
from rodloop_cli.march.stages import StageModes
from rodloop_cli.march.state import State, Step
from rodloop_cli.march.work import Work
from rodloop_cli.numerics.control import without_sliver
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import NODAL, Motion

NEWTON_TARGET = 1e-11
"""Position error at which Newton stops: far below the scheme's own error, above round-off amplified by Δt⁻²."""

SMALLEST_SPLIT = 2.0**-10
"""Of the given step: how far a failing step is split before the run gives up."""

END = np.array([1.0])
SINGLE = StageModes(np.ones(1), np.ones((1, 1)), np.ones((1, 1)))


class FixedMarcher:
    """Steps of ``dt`` to ``t_end``, the last ones shortened to end there; a step on which Newton fails is halved.

    state: where the loop is;  before: the state one step earlier;  moment: (n, m + 1) now, None at the start;
    last: the predictor's memory;  proposal: the next step to try.
    """

    def __init__(self, state: State, t_end: float, dt: float, work: Work) -> None:
        self.t_end, self.dt, self.work = t_end, dt, work
        self.newton = Newton(SINGLE, work)
        self.state = state
        self.before: State | None = None
        self.moment: Array | None = None
        self.last: Past | None = None
        self.proposal = dt

    def __iter__(self) -> Iterator[Step]:
        """Steps up to ``t_end``. Raises ConvergenceError when splitting a step does not help."""
        while self.t_end - self.state.time > 1e-9 * self.dt:
            size = without_sliver(self.proposal, self.t_end - self.state.time)
            step = self._step(size)
            if step is None:
                self._split(size)
                continue
            self.work.steps += 1
            self.last = _memory(self.before, self.last, step)
            self.before, self.state, self.moment = self.state, step.end, step.fields.moment[-1]
            self.proposal = min(self.dt, 2 * size)
            yield step

    def _split(self, size: float) -> None:
        self.work.newton_failures += 1
        self.proposal = size / 2
        if self.proposal < SMALLEST_SPLIT * self.dt:
            raise ConvergenceError(
                f"no convergence at t = {self.state.time:.6g}: Newton's iteration failed down to a step of "
                f"{self.proposal:.1e}; try a smaller dt, more grid points (N) or scheme: radau"
            )

    def _step(self, size: float) -> Step | None:
        state = self.state
        (a, b, c), before = self._formula(size)
        motion = _motion((a, b, c), size, state, before)
        guess = predict(state, self.last, END, size)
        solution = self.newton.solve(state.equations, motion, guess, size / a, state.force, NEWTON_TARGET)
        if solution is None:
            return None
        rates = (a * solution.unknowns + b * state.unknowns + c * before.unknowns) / size
        made = solution.unknowns, rates, solution.fields, solution.iterations
        return Step(state, size, END, *made, error=0.0, moment_at_start=self.moment)

    def _formula(self, size: float) -> tuple[tuple[float, float, float], State]:
        """Weights (times 1/Δt) of now, the last and the second last state, and that state."""
        if self.before is None:
            return (1.0, -1.0, 0.0), self.state
        ratio = size / (self.state.time - self.before.time)
        return ((1 + 2 * ratio) / (1 + ratio), -(1 + ratio), ratio**2 / (1 + ratio)), self.before


def _memory(before: State | None, last: Past | None, step: Step) -> Past:
    """The last two steps as one, whose stages are their ends: the first guess is as good as the scheme then.

    Its nodes come from lengths, not from differences of times: the predictor keeps a matrix for each set of nodes.
    """
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
