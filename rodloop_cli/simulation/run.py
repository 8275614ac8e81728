"""The composition: a case in, rows and an outcome out."""

import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import pi
from typing import Protocol

import numpy as np

from rodloop_cli.case import Case
from rodloop_cli.case.title import title_of
from rodloop_cli.dataset.provenance import outcome_attributes, run_attributes
from rodloop_cli.dataset.rows import RowSink
from rodloop_cli.dataset.variables import Attribute
from rodloop_cli.errors import ConvergenceError
from rodloop_cli.march.bdf2 import FixedMarcher
from rodloop_cli.march.loop import Marcher, Plan
from rodloop_cli.march.refine import Refiner
from rodloop_cli.march.state import State, Step
from rodloop_cli.march.work import Work
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.energies import Quadrature
from rodloop_cli.physics.lobes import find_lobes
from rodloop_cli.simulation.amplification import Amplification
from rodloop_cli.simulation.events import CrossingWatch
from rodloop_cli.simulation.record import Recorder, Row
from rodloop_cli.simulation.rest import RestWatch
from rodloop_cli.simulation.start import Start, fastest_time, growth_time, start
from rodloop_cli.simulation.summary import Summary

LOG = logging.getLogger(__name__)
"""The mesh (-v) and every step (-vv)."""

Progress = Callable[[float], None]
"""Told the time reached, after every step."""

FIRST_STEP, FIRST_STEP_WITHOUT_JUNCTIONS = 0.01, 0.3
"""First step proposed, over the time of the fastest motion that the load starts. Junctions of stiffness meet the load
with waves of every length, and need short ones."""

REST = 1e-6
"""Distance from an equilibrium at which a run of fixed steps has settled."""


KINKED = "the perturbation kinks the loop at its stiffness junctions: "
JUMPING_MOMENT = {
    "radau": f"{KINKED}positions are good to tol or 1e-3 of its amplitude, energies to less; compare with tol/10",
    "bdf2": f"{KINKED}short waves are lost, and their energy; compare with half dt and twice N",
}
"""By scheme. Measured on loops of stiffness ratio 2 to 14 and amplitude 1e-3 to 4e-2, see docs/accuracy.md."""


class BetweenSteps(Protocol):
    """Whoever wants to do something between two steps: write a checkpoint, end the run."""

    def after_step(self) -> None:
        """Called when a step and its rows are done."""


@dataclass
class Run:
    """A simulation that is ready to go, or on its way."""

    case: Case
    begun: Start
    marcher: Marcher | FixedMarcher
    recorder: Recorder
    rest: RestWatch
    summary: Summary

    @classmethod
    def of(cls, case: Case) -> "Run":
        """Build the initial state. Raises ConvergenceError where it cannot be found."""
        begun = start(case)
        work = Work()
        recorder = Recorder(begun.rod, begun.load, case.output_points, case.times)
        summary = Summary(work, Amplification(begun.rod, begun.load), energies=pi * (1 + abs(case.p)))
        return cls(case, begun, _marcher(case, begun, work), recorder, RestWatch(case.tol or REST), summary)

    @property
    def work(self) -> Work:
        """What the run has cost so far."""
        return self.summary.work

    @property
    def attributes(self) -> dict[str, Attribute]:
        """What is known of the result beforehand."""
        case = self.case
        text, key = case.to_yaml(), case.sha256
        known = run_attributes(title=title_of(case), case_text=text, case_sha256=key, command="rodloop run")
        return known | ({"warning": self.warning} if self.warning else {})

    @property
    def warning(self) -> str:
        """What makes this run less accurate than others, as far as that is known beforehand; empty if nothing."""
        kinked = self.begun.waves and self.begun.rod.has_stiffness_contrast
        return JUMPING_MOMENT[self.case.scheme] if kinked else ""

    def into(self, sink: RowSink, progress: Progress | None = None, between: BetweenSteps | None = None) -> Summary:
        """Run to the end, or to the event that stops it, and close the sink with the outcome.

        Raises ConvergenceError after having stored everything up to the failure, with the outcome in the attributes.
        """
        try:
            self.summary.outcome = self._follow(sink, progress, between)
        except ConvergenceError as error:
            self.summary.outcome = str(error)
            self._finish(sink)
            raise
        self._finish(sink)
        return self.summary

    def _follow(self, sink: RowSink, progress: Progress | None, between: BetweenSteps | None) -> str:
        crossing, cells = CrossingWatch(), 0
        if not self.recorder.begun:
            for row in self.recorder.start(self.begun.step):
                self._store(row, sink)
        for step in self.marcher:
            cells = _logged(step, cells)
            settled = "settled" in self.case.stop_at and self.rest.settled(step.end, self._departure(step))
            stopped = self._record(step, sink, crossing, last=settled)
            if progress:
                progress(step.start.time + step.size if stopped is None else stopped)
            if stopped is not None and stopped == self.summary.first_crossing:
                return f"stopped at first crossing, t = {stopped:.4g}"
            if stopped is not None:
                return f"settled at an equilibrium, t = {stopped:.4g}"
            if between:
                between.after_step()
        return "reached t_end"

    def _departure(self, step: Step) -> float:
        """How far the loop has gone at the end of a step."""
        base = self.marcher.base if isinstance(self.marcher, Marcher) else self.begun.state.position
        return self.begun.departure.of(step.end, base)

    def _record(self, step: Step, sink: RowSink, crossing: CrossingWatch, *, last: bool) -> float | None:
        """Store what is due in a step, its end too if it is the ``last``; the time at which the run is to stop, if it
        is.
        """
        summary = self.summary
        if isinstance(self.marcher, Marcher):
            summary.amplification.watch(step, self._departure(step) / self.begun.departure.scale)
        if summary.first_crossing is None:
            summary.first_crossing = crossing.first_in(step)
        stopped = summary.first_crossing if "crossing" in self.case.stop_at else None
        if stopped is None and last:
            stopped = step.end.time
        for row in self.recorder.during(step, summary.first_crossing, stopped):
            self._store(row, sink)
        sink.flush_if_due()
        summary.extrema.watch(step, until=stopped)
        return stopped

    def revisit(self, rows: Iterable[tuple[float, Array]]) -> None:
        """Let a continued run see the curvature of the rows that were stored before it."""
        for time, curvature in rows:
            self.summary.lobes.watch(time, curvature)

    def _store(self, row: Row, sink: RowSink) -> None:
        curvature = np.asarray(row["curvature"])
        tops = find_lobes(curvature)
        row["lobes"] = len(tops)
        sink.append(row)
        if not row["crossing"]:
            self.summary.lobes.watch(float(row["t"]), curvature, tops)

    def _finish(self, sink: RowSink) -> None:
        account, summary = self.recorder.account, self.summary
        summary.energy_residual, summary.energy_change = account.largest_residual, account.largest_change
        summary.cells = self.marcher.state.equations.mesh.cells
        summary.extrema.first_area, summary.extrema.last_area = map(_area, (self.begun.state, self.marcher.state))
        outcome = outcome_attributes(summary.outcome, summary.totals)
        warnings = [self.warning] * bool(self.warning) + summary.warnings
        warned: dict[str, Attribute] = {"warning": "; ".join(warnings)} if warnings else {}
        sink.finish(outcome | summary.findings | summary.lobe_events | warned)


def _logged(step: Step, cells: int) -> int:
    """Tell of a step, and of the mesh if it is not the one of so many cells before."""
    mesh = step.start.equations.mesh
    if mesh.cells != cells:
        points = step.start.equations.rule.m
        LOG.info("t = %.6g: %d cells of %d Gauss points", step.start.time, mesh.cells, points)
    # bdf2 has no estimate.
    error = f", error {step.error:.2g} of what it may be" if step.error else ""
    end = step.start.time + step.size
    LOG.debug("t = %.6g: step of %.3g, %d Newton iterations%s", end, step.size, step.newton_iterations, error)
    return mesh.cells


def _area(state: State) -> float:
    equations = state.equations
    tangent = equations.tangent(state.unknowns[None])
    return Quadrature(equations.mesh, equations.rule).area(state.position[:, None, :, :-1], tangent).item()


def _marcher(case: Case, begun: Start, work: Work) -> Marcher | FixedMarcher:
    if case.scheme == "bdf2":
        assert case.dt is not None
        return FixedMarcher(begun.state, case.t_end, case.dt, work)
    assert case.tol is not None
    first = FIRST_STEP if begun.rod.has_stiffness_contrast else FIRST_STEP_WITHOUT_JUNCTIONS
    first *= fastest_time(begun.load, begun.rod)
    longest = case.dt or case.t_end
    plan = Plan(case.t_end, case.tol, stages_for(case.tol), longest, min(first, longest))
    horizon = growth_time(begun.load, begun.rod) if begun.rod.has_stiffness_contrast else 0.0
    refiner = Refiner(fixed=case.N is not None, horizon=horizon)
    return Marcher(begun.state, plan, refiner, begun.departure, work)


def stages_for(tol: float) -> int:
    """Stages of the Radau method: the more the tighter the tolerance.

    Measured where the error limits the steps: five need no more time than three from tol = 1e-2 on, seven no more than
    five from 3e-4 on; nine gain nothing. Where Newton limits them, see `march.loop.STAGES_WHEN_HARD`.
    """
    return 5 if tol > 3e-4 else 7
