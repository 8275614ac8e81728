"""Hands tasks to an executor and notes how they end."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from rodloop_cli.sweep.executors import Crew
from rodloop_cli.sweep.manifest import Manifest
from rodloop_cli.sweep.task import Ending, Report, Task, failure

PATIENCE = 0.5
"""Seconds between two looks at members that another sweep is running."""

Watcher = Callable[[Task, Report], None]
"""Told of every task that ended."""


@dataclass
class Tally:
    """How many members ended in which way."""

    ran: int = 0
    was_done: int = 0
    failed: int = 0

    def count(self, report: Report) -> None:
        """Add one."""
        setattr(self, report.ending.name, getattr(self, report.ending.name) + 1)


@dataclass
class Conductor:
    """Keeps an executor supplied with tasks, a few at a time: a million of them need no memory."""

    crew: Crew
    watcher: Watcher
    _running: dict[Future[Report], Task] = field(default_factory=dict)
    _busy: list[Task] = field(default_factory=list)

    def run(self, tasks: Iterator[Task]) -> None:
        """Run all tasks; those that another sweep is at are looked at again until they are done."""
        self._supply(tasks)
        while self._busy:
            time.sleep(PATIENCE)
            again, self._busy = self._busy, []
            self._supply(iter(again))

    def _supply(self, tasks: Iterator[Task]) -> None:
        for task in tasks:
            self._running[self.crew.executor.submit(run_member, task)] = task
            if len(self._running) >= self.crew.tasks:
                self._collect()
        while self._running:
            self._collect()

    def _collect(self) -> None:
        for future in wait(self._running, return_when=FIRST_COMPLETED).done:
            task = self._running.pop(future)
            report = _report(task, future)
            if report.ending is Ending.is_busy:
                self._busy.append(task)
            else:
                self.watcher(task, report)


def run_member(task: Task) -> Report:
    """What a worker does: see `rodloop_cli.sweep.worker.run`."""
    from rodloop_cli.sweep.worker import run  # noqa: PLC0415  half a second, in the worker alone

    return run(task)


def _report(task: Task, future: Future[Report]) -> Report:
    error = future.exception()
    if error is None:
        return future.result()
    # A worker died, or could not write: whatever it was, it is this member's failure and no other's.
    outcome = " ".join(f"{error}".split()) or type(error).__name__
    with suppress(OSError):  # on a full disk the next sweep finds no row and runs the member as well
        Manifest(Path(task.folder)).append(failure(task.name, task.key, outcome))
    return Report(Ending.failed, outcome)
