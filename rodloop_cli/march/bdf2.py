"""The paper's time stepping (Appendix B): fixed-step BDF2 of position and of velocity, backward Euler at first.

Eq. (B.3) with a variable ratio of steps, so that a step on which Newton fails can be split and the last one can end on time. On one-point
boxes this is the paper's scheme.
"""

from collections.abc import Iterator

import numpy as np

from rodloop_cli.errors import ConvergenceError, SingularSystem
from rodloop_cli.march.predictor import predict
from rodloop_cli.march.stages import Instant, Linearisation, StageModes, solve_stages
from rodloop_cli.march.state import State, Step
from rodloop_cli.march.work import Work
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import Fields, Motion

NEWTON_TARGET = 1e-10
"""Position error at which Newton stops: far below the scheme's own error, above round-off amplified by Δt⁻²."""

SMALLEST_SPLIT = 2.0**-10
"""Of the given step: how far a failing step is split before the run gives up."""

END = np.array([1.0])
SINGLE = np.ones((1, 1), dtype=complex)


def march(state: State, t_end: float, dt: float, work: Work) -> Iterator[Step]:
    """Steps of ``dt`` to ``t_end``, the last one shortened to end there; a step on which Newton fails is halved.

    Raises ConvergenceError when splitting does not help.
    """
    last: Step | None = None
    size = dt
    while t_end - state.time > 1e-9 * dt:
        remaining = t_end - state.time
        size = remaining if size > remaining * (1 - 1e-9) else size
        step = _step(state, last, size, work)
        if step is None:
            work.newton_failures += 1
            size /= 2
            if size < SMALLEST_SPLIT * dt:
                raise ConvergenceError(
                    f"no convergence at t = {state.time:.6g}: Newton's iteration failed down to a step of {size:.1e}; "
                    "try a smaller dt, more grid points (N) or scheme: radau"
                )
            continue
        work.steps += 1
        yield step
        state, last = step.end, step
        size = min(dt, 2 * size)


def _step(state: State, last: Step | None, size: float, work: Work) -> Step | None:
    now, rate, motion = _formula(state, last, size)
    guess = predict(state, last, END, size)

    def renew(fields: Fields, trusted: bool) -> Linearisation:
        work.factorizations += 1
        instant = Instant.of_stage(fields, 0, None if trusted else state.force)
        return Linearisation(state.equations, StageModes(np.array([now + 0j]), SINGLE, SINGLE), size, instant)

    try:
        solution, _ = solve_stages(state.equations, motion, guess, None, renew, NEWTON_TARGET)
    except SingularSystem:
        return None
    if solution is None:
        return None
    work.newton_iterations += solution.iterations
    rates = rate(solution.unknowns)
    return Step(state, size, END, solution.unknowns, rates, solution.fields, solution.iterations, 0.0)


def _formula(state: State, last: Step | None, size: float) -> tuple[float, "_Rate", Motion]:
    """Leading coefficient (times the step), the formula for rates, and the motion."""
    if last is None:
        weights = (1.0, -1.0, 0.0)
        before = state
    else:
        ratio = size / last.size
        weights = ((1 + 2 * ratio) / (1 + ratio), -(1 + ratio), ratio**2 / (1 + ratio))
        before = last.start
    past = _Rate(weights, size, state.unknowns, before.unknowns)
    motion = Motion(
        np.array([[weights[0] / size]]),
        ((weights[1] * state.position + weights[2] * before.position) / size)[:, None],
        ((weights[1] * state.velocity + weights[2] * before.velocity) / size)[:, None],
    )
    return weights[0], past, motion


class _Rate:
    """(1, n, 6 + m): the same formula applied to all unknowns, for the dense output."""

    def __init__(self, weights: tuple[float, float, float], size: float, now: Array, before: Array) -> None:
        self._weights, self._size, self._now, self._before = weights, size, now, before

    def __call__(self, unknowns: Array) -> Array:
        a, b, c = self._weights
        rate: Array = (a * unknowns + b * self._now + c * self._before) / self._size
        return rate
