"""The composition: a case in, rows and an outcome out."""

import time
from collections.abc import Callable, Iterator
from contextlib import closing
from dataclasses import dataclass

from rodloop_cli.case import Case
from rodloop_cli.dataset.provenance import outcome_attributes, run_attributes
from rodloop_cli.dataset.rows import RowSink
from rodloop_cli.dataset.variables import Attribute
from rodloop_cli.errors import ConvergenceError
from rodloop_cli.march import bdf2, loop
from rodloop_cli.march.refine import Refiner
from rodloop_cli.march.state import Step
from rodloop_cli.march.work import Work
from rodloop_cli.simulation.events import AreaExtrema, CrossingWatch, RestWatch
from rodloop_cli.simulation.record import Recorder
from rodloop_cli.simulation.start import STARTING_TIME, Start, fastest_time, start
from rodloop_cli.simulation.summary import Summary

Progress = Callable[[float], None]
"""Told the time reached, after every step."""

FIRST_STEP = 10.0
"""First step proposed, in units of the starting step: the impulsive start is met with short steps."""


@dataclass
class Run:
    """A simulation that is ready to go: its start, what it watches, what it has done."""

    case: Case
    begun: Start
    recorder: Recorder
    work: Work

    @classmethod
    def of(cls, case: Case) -> "Run":
        """Raises ConvergenceError where the initial state cannot be found."""
        begun = start(case)
        recorder = Recorder(begun.rod, begun.load, case.output_points, case.times)
        return cls(case, begun, recorder, Work())

    @property
    def attributes(self) -> dict[str, Attribute]:
        """What is known of the result beforehand."""
        case = self.case
        return run_attributes(title=case.title, case_text=case.to_yaml(), case_sha256=case.sha256, command="rodloop")

    def into(self, sink: RowSink, progress: Progress | None = None) -> Summary:
        """Run to the end, or to the event that stops it, and close the sink with the outcome.

        Raises ConvergenceError after having stored everything up to the failure, with the outcome in the attributes.
        """
        clock = time.perf_counter()
        summary = Summary(self.work, AreaExtrema())
        try:
            with closing(self._steps()) as steps:
                self._follow(steps, sink, summary, progress)
        except ConvergenceError as error:
            summary.outcome = str(error)
            self._finish(sink, summary, clock)
            raise
        self._finish(sink, summary, clock)
        return summary

    def _follow(self, steps: Iterator[Step], sink: RowSink, summary: Summary, progress: Progress | None) -> None:
        crossing, rest = CrossingWatch(), RestWatch(self.case.tol or 1e-6)
        for row in self.recorder.start(self.begun.step):
            sink.append(row)
        for step in steps:
            summary.cells = step.start.equations.mesh.cells
            if summary.first_crossing is None:
                summary.first_crossing = crossing.first_in(step)
            stopped = summary.first_crossing if "crossing" in self.case.stop_at else None
            for row in self.recorder.during(step, summary.first_crossing, stopped):
                sink.append(row)
            sink.flush_if_due()
            if progress:
                progress(step.start.time + step.size if stopped is None else stopped)
            summary.extrema.watch(step)
            if stopped is not None:
                summary.outcome = f"stopped at first crossing, t = {stopped:.4g}"
                return
            if "settled" in self.case.stop_at and rest.settled(step.end):
                summary.outcome = f"settled at an equilibrium, t = {step.end.time:.4g}"
                return
        summary.outcome = "reached t_end"

    def _steps(self) -> Iterator[Step]:
        case, begun = self.case, self.begun
        if case.scheme == "bdf2":
            assert case.dt is not None
            return bdf2.march(begun.state, case.t_end, case.dt, self.work)
        assert case.tol is not None
        plan = loop.Plan(
            t_end=case.t_end,
            tol=case.tol,
            stages=stages_for(case.tol),
            longest=case.dt or case.t_end,
            first=FIRST_STEP * STARTING_TIME * fastest_time(begun.load, begun.rod),
        )
        return loop.march(begun.state, plan, Refiner(fixed=case.N is not None), begun.departure, self.work)

    def _finish(self, sink: RowSink, summary: Summary, clock: float) -> None:
        account = self.recorder.account
        summary.energy_residual, summary.energy_change = account.largest_residual, account.largest_change
        summary.wall_seconds = time.perf_counter() - clock
        sink.finish(outcome_attributes(summary.outcome, summary.totals) | summary.findings)


def stages_for(tol: float) -> int:
    """Stages of the Radau method: the more the tighter the tolerance."""
    return 3 if tol >= 1e-3 else 5 if tol > 1e-7 else 7
