"""The composition of a sweep: file to plan, plan to results, results to sweep.nc."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, field
from pathlib import Path

from rodloop_cli.dataset.failures import writing
from rodloop_cli.errors import Interrupted, OutputError, SweepError
from rodloop_cli.sweep.conduct import Conductor, Tally
from rodloop_cli.sweep.executors import check_scheduler, crew
from rodloop_cli.sweep.file import read_sweep
from rodloop_cli.sweep.gather import gather
from rodloop_cli.sweep.ledger import Ledger
from rodloop_cli.sweep.manifest import SUMMARY
from rodloop_cli.sweep.plan import Member, Plan, Shard, planned
from rodloop_cli.sweep.task import CLAIMS, Ending, Report, Task

DEFAULT_JOBS = 2
Watcher = Callable[[Report], None]
"""Told how each member ended."""

MOST_NAMED = 10
"""Failed members that are named at the end; the others are in sweep.nc."""


@dataclass
class Sweep:
    """A sweep that is ready to go: its members, those that have to run, what became of them."""

    plan: Plan
    folder: Path
    to_run: list[Member]
    is_whole: bool
    replaced: int = 0
    """Result files in the folder with the names of members, but of other cases."""
    tally: Tally = field(default_factory=Tally)
    failures: list[str] = field(default_factory=list)

    @classmethod
    def of(
        cls,
        path: str | os.PathLike[str],
        folder: str | os.PathLike[str],
        overrides: Iterable[str] = (),
        shard: Shard | None = None,
        *,
        read_only: bool = False,
    ) -> Sweep:
        """Read and check everything; look up what is done.

        Raises CaseError with all that is wrong. ``read_only``: nothing is written, for a look at what would run.
        """
        plan = planned(read_sweep(os.fspath(path), overrides), shard)
        place = Path(folder)
        if place.exists() and not place.is_dir():
            raise OutputError(f"{place} is not a folder; choose another place with -o")
        ledger = Ledger(place, read_only=read_only)
        ledger.refresh()
        fields = plan.sweep.keeps_fields
        left = [member for member in plan.members if not ledger.is_done(member.name, member.key, keeps_fields=fields)]
        replaced = sum(ledger.is_of_another_case(member.name, member.key) for member in left) if fields else 0
        # A long member that starts last keeps one worker busy while the others have nothing left to do.
        left.sort(key=lambda member: -member.cost)
        tally = Tally(was_done=len(plan.members) - len(left))
        return cls(plan, place, left, shard is None or shard.count == 1, replaced, tally)

    def run(
        self,
        executor: str | Executor = "process",
        jobs: int = DEFAULT_JOBS,
        scheduler: str | None = None,
        watcher: Watcher | None = None,
    ) -> Path:
        """Run what is left and write sweep.nc, whose path is returned; of one shard, only the results.

        Raises SweepError if members failed and Interrupted on Ctrl-C, both with sweep.nc written.
        """
        check_scheduler(executor, scheduler)
        self._make_folder()
        try:
            self._run(executor, jobs, scheduler, watcher)
        except KeyboardInterrupt:
            self._gather()
            done = f"{self.tally.ran + self.tally.was_done} of {len(self.plan.members)} members are done"
            raise Interrupted(f"interrupted; {done} and kept in {self.folder}; the same command goes on") from None
        self._gather()
        if self.failures:
            raise SweepError("\n".join(self._failed()))
        return self.result

    def _run(self, executor: str | Executor, jobs: int, scheduler: str | None, watcher: Watcher | None) -> None:
        def noted(task: Task, report: Report) -> None:
            self._note(task, report)
            if watcher:
                watcher(report)

        if self.to_run:
            with crew(executor, min(jobs, len(self.to_run)), scheduler) as hired:
                Conductor(hired, noted).run(self._tasks())

    def _tasks(self) -> Iterator[Task]:
        folder, fields = os.fspath(self.folder.absolute()), self.plan.sweep.keeps_fields
        for member in self.to_run:
            yield Task(folder, member.name, member.key, self.plan.values(member), fields)

    def _note(self, task: Task, report: Report) -> None:
        self.tally.count(report)
        if report.ending is Ending.failed and len(self.failures) < MOST_NAMED:
            self.failures.append(f"{task.name}: {report.outcome}")

    def _failed(self) -> list[str]:
        count = self.tally.failed
        more = [f"... and {count - MOST_NAMED} more"] if count > MOST_NAMED else []
        head = f"{count} of {len(self.plan.members)} members failed; the others are kept, the same command tries again"
        return [*self.failures, *more, head]

    @property
    def result(self) -> Path:
        """What there is in the end: sweep.nc, or of one shard the folder."""
        return self.folder / SUMMARY if self.is_whole else self.folder

    def _make_folder(self) -> None:
        with writing(self.folder, str):
            self.folder.mkdir(parents=True, exist_ok=True)

    def _gather(self) -> None:
        with contextlib.suppress(OSError):  # another sweep may be using it
            (self.folder / CLAIMS).rmdir()
        if self.is_whole:
            with writing(self.result, str):
                gather(self.plan, self.folder)


def run_sweep(
    path: str | os.PathLike[str],
    folder: str | os.PathLike[str],
    overrides: Iterable[str] = (),
    *,
    jobs: int = DEFAULT_JOBS,
    executor: str | Executor = "process",
    scheduler: str | None = None,
) -> Path:
    """Run the members of a sweep file that have no result in the folder yet; returns the path of sweep.nc there.

    ``executor``: "process" (``jobs`` of them, here), "dask" (with the address of a ``scheduler``), "mpi", or any
    `concurrent.futures.Executor`, which is given ``jobs`` tasks at a time.
    Raises CaseError before anything runs, SweepError after everything ran if members failed.
    """
    return Sweep.of(path, folder, overrides).run(executor, jobs, scheduler)
