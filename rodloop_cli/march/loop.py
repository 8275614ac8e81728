"""The time loop with error control: a generator of accepted steps."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.march.radau import RadauStepper
from rodloop_cli.march.refine import Refiner
from rodloop_cli.march.state import State, Step
from rodloop_cli.march.work import Work
from rodloop_cli.numerics.control import CUT_AFTER_FAILURE, Controller, settle_on
from rodloop_cli.numerics.gauss import Array

SMALLEST_STEP = 1e-13
"""Of t_end: below this the time hardly advances in double precision."""

ROUND_OFF = 1e-12
"""The smallest position error that a step can be asked for."""

LOOSEST = 1e-3
SHARE_AT_LOOSEST = 0.6
TIGHTENING = 0.2
"""The share of the tolerance that one step may use is SHARE_AT_LOOSEST (tol/LOOSEST)^TIGHTENING: the errors of more and more steps
add up. Fitted so that (error of the whole run)/tol stays of order one from 1e-3 to 1e-8; see docs/accuracy.md."""


@dataclass(frozen=True)
class Plan:
    """What is asked of a run: the end, the accuracy in positions, the number of stages, the longest step and the first."""

    t_end: float
    tol: float
    stages: int
    longest: float
    first: float

    def allowance(self, scale: float) -> float:
        """Position error allowed in a step, for a departure ``scale``."""
        share = SHARE_AT_LOOSEST * (self.tol / LOOSEST) ** TIGHTENING
        return max(ROUND_OFF, share * self.tol * scale)


@dataclass(frozen=True, eq=False)
class Departure:
    """How far the loop has gone from the base shape that it leaves, at most 1 (the radius).

    A perturbation of an unstable shape grows e^(ωt)-fold, and so does an error made early: the tolerance is meant relative to the
    departure. ``scale`` is the size of the motion that is about to start, from the perturbation and the load.
    """

    scale: float

    def of(self, state: State, base: Array) -> float:
        """``base`` (2, n, m + 1) is the base shape on the state's mesh."""
        return min(1.0, max(self.scale, float(np.abs(state.position - base).max())))


def march(state: State, plan: Plan, refiner: Refiner, departure: Departure, work: Work) -> Iterator[Step]:
    """Accepted steps from ``state`` to ``plan.t_end``.

    Raises ConvergenceError, with the time and what to try, when steps become too short.
    """
    stepper = RadauStepper(plan.stages, work)
    controller = Controller(plan.stages + 1)
    last: Step | None = None
    proposal = min(plan.first, plan.longest)
    base = state.position
    while state.time < plan.t_end:
        remaining = plan.t_end - state.time
        size = settle_on(min(proposal, plan.longest), stepper.reusable_size)
        # A last step of nearly the remaining length is stretched to it, never followed by a sliver.
        size = remaining if size > 0.999 * remaining else size
        if size < SMALLEST_STEP * plan.t_end:
            raise ConvergenceError(_gave_up(state.time, size))
        scale = departure.of(state, base)
        step = stepper.step(state, last, size, plan.allowance(scale))
        if step is None:
            work.newton_failures += 1
            proposal = CUT_AFTER_FAILURE * size
            continue
        factor = controller.factor(size, step.error)
        proposal = factor * size
        if step.error > 1:
            work.rejected += 1
            continue
        finer = refiner.refined(step, plan.tol * scale)
        if finer is not None:
            work.refinements += 1
            state, base = finer.transfer(state), finer.interpolate(base)
            last, proposal = None, size
            continue
        controller = controller.accepted(size, step.error)
        work.steps += 1
        yield step
        state, last = step.end, step


def _gave_up(time: float, size: float) -> str:
    return (
        f"no convergence at t = {time:.6g}: Newton's iteration failed down to a step of {size:.1e}; "
        "try a looser tol, a smaller load or contrast, or more cells (N)"
    )
