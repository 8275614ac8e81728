"""The time loop with error control."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.march.predictor import Past
from rodloop_cli.march.radau import ITERATION_ERROR, RadauStepper
from rodloop_cli.march.refine import ROUND_OFF, Finer, Refiner
from rodloop_cli.march.state import State, Step
from rodloop_cli.march.work import Work
from rodloop_cli.numerics.control import CUT_AFTER_FAILURE, Controller, settle_on, without_sliver
from rodloop_cli.numerics.gauss import Array

SMALLEST_STEP = 1e-13
"""Of t_end: below this the time hardly advances in double precision."""

MANY_ITERATIONS = 6
CUT_AFTER_MANY = 0.85
"""A step on which Newton needs as many is followed by a shorter one, which costs less than the iterations do."""

LOOSEST = 1e-3
SHARE_AT_LOOSEST = 0.6
TIGHTENING = 0.2
"""The share of the tolerance that one step may use is SHARE_AT_LOOSEST (tol/LOOSEST)^TIGHTENING: the errors of more
and more steps add up. Fitted so that (error of the whole run)/tol stays of order one from 1e-3 to 1e-8; see
docs/accuracy.md."""

FAILING = 0.1
"""Newton failures in a step from which a run is hard."""

TARGET_WHEN_HARD = 5e-6
"""Newton's target in a hard run is not above this. What it leaves becomes a force of that over Δt², and the steps of
such a run are short: with 1e-4, which is what tol = 1e-2 would give, five of 290 random runs came to where no step
succeeds."""

MANY_FAILURES = 20
STAGES_WHEN_HARD = 3
"""A hard run with that many failures goes on with fewer stages: its steps are limited by Newton's iteration, whose
contraction suffers less from a step the fewer stages it couples."""


@dataclass(frozen=True)
class Plan:
    """What is asked of a run: the end, the accuracy in positions, the number of stages, the longest step and the
    first.
    """

    t_end: float
    tol: float
    stages: int
    longest: float
    first: float

    @property
    def iteration_error(self) -> float:
        """Newton's share of the error: who asks for a loose tolerance does not look at energies."""
        return 3 * ITERATION_ERROR if self.tol >= LOOSEST else ITERATION_ERROR

    def allowance(self, scale: float) -> float:
        """Position error allowed in a step, for a departure ``scale``."""
        share: float = SHARE_AT_LOOSEST * (self.tol / LOOSEST) ** TIGHTENING
        return max(ROUND_OFF, share * self.tol * scale)


@dataclass(frozen=True, eq=False)
class Departure:
    """How far the loop has gone from the base shape that it leaves, at most 1 (the radius).

    A perturbation of an unstable shape grows e^(ωt)-fold, and so does an error made early: the tolerance is meant
    relative to the departure. ``scale`` is the size of the motion that is about to start, from the perturbation and
    the load.
    """

    scale: float

    def of(self, state: State, base: Array) -> float:
        """``base`` (2, n, m + 1) is the base shape on the state's mesh."""
        return min(1.0, max(self.scale, float(np.abs(state.position - base).max())))


class Marcher:
    """The march of one run; its attributes are all that a continued run needs to know.

    state: where the loop is;  base: the base shape (2, n, m + 1) on its mesh;  last: the predictor's memory;
    proposal: the next step to try;  stepper, controller: see `use_stages`.
    """

    def __init__(self, state: State, plan: Plan, refiner: Refiner, departure: Departure, work: Work) -> None:
        self.plan, self.work = plan, work
        self._refiner, self._departure = refiner, departure
        self.use_stages(plan.stages)
        self.state, self.base = state, state.position
        self.last: Past | None = None
        self.proposal = plan.first

    def use_stages(self, stages: int) -> None:
        """Make the steps that follow with so many stages."""
        self.stepper = RadauStepper(stages, self.work, self.plan.iteration_error)
        self.controller = Controller(stages + 1)

    def __iter__(self) -> Iterator[Step]:
        """Accepted steps up to ``plan.t_end``.

        Raises ConvergenceError, with the time and what to try, when steps become too short.
        """
        # The sum of the steps may miss the end by a unit in the last place.
        while self.plan.t_end - self.state.time > SMALLEST_STEP * self.plan.t_end:
            step = self._attempt()
            if step is not None:
                yield step

    def _attempt(self) -> Step | None:
        """One step; None if it was rejected, or taken back to be done again on a finer mesh."""
        size = self._size()
        scale = self._departure.of(self.state, self.base)
        target = TARGET_WHEN_HARD if self._hard else np.inf
        step = self.stepper.step(self.state, self.last, size, self.plan.allowance(scale), target)
        if step is None:
            self._failed(size)
            return None
        self.proposal = self._next(step)
        if step.error > 1:
            self.work.rejected += 1
            return None
        finer = self._refiner.refined(step, self.plan.tol * scale)
        if finer is not None:
            self._refine(finer, size)
            return None
        self.controller = self.controller.accepted(size, step.error)
        self.work.steps += 1
        self.state, self.last = step.end, Past.of(step)
        return step

    @property
    def _hard(self) -> bool:
        return self.work.newton_failures > FAILING * self.work.steps

    def _failed(self, size: float) -> None:
        """What follows a step on which Newton failed.

        One that fails although it is shorter than the last suffers from the gaps that the last one left. Closing them
        changes velocities by ε/Δt, and is left alone after a failure that only ends the growth of steps.
        """
        self.work.newton_failures += 1
        self.proposal = CUT_AFTER_FAILURE * size
        if self.last is not None and size < self.last.size:
            self.state = self.state.closed()
        if self._hard and self.work.newton_failures >= MANY_FAILURES and self.stepper.method.stages > STAGES_WHEN_HARD:
            self.use_stages(STAGES_WHEN_HARD)

    def _next(self, step: Step) -> float:
        proposal = self.controller.factor(step.size, step.error) * step.size
        return min(proposal, CUT_AFTER_MANY * step.size) if step.newton_iterations >= MANY_ITERATIONS else proposal

    def _size(self) -> float:
        """The next step to try."""
        size = settle_on(min(self.proposal, self.plan.longest), self.stepper.newton.reusable_length)
        size = without_sliver(size, self.plan.t_end - self.state.time)
        if size < SMALLEST_STEP * self.plan.t_end:
            raise ConvergenceError(_gave_up(self.state.time, size))
        return size

    def _refine(self, finer: Finer, size: float) -> None:
        self.work.refinements += 1
        self.state, self.base = finer.transfer(self.state), finer.interpolate(self.base)
        self.last, self.proposal = None, size


def _gave_up(time: float, size: float) -> str:
    return (
        f"no convergence at t = {time:.6g}: Newton's iteration failed down to a step of {size:.1e}; "
        "try a looser tol, a smaller load or contrast, or more cells (N)"
    )
