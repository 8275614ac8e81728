"""One member in a worker process: run it if nobody has, write its result and its line in the manifest.

Imported by every worker: nothing here may load more than the solver and the netCDF writer.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from threadpoolctl import threadpool_limits

from rodloop_cli.case import Case
from rodloop_cli.dataset.lock import OutputLock
from rodloop_cli.dataset.writer import RunWriter
from rodloop_cli.errors import ConvergenceError, RodloopError
from rodloop_cli.simulation import Run
from rodloop_cli.sweep.columns import Row, status_of
from rodloop_cli.sweep.ledger import Ledger
from rodloop_cli.sweep.manifest import Manifest
from rodloop_cli.sweep.observe import Nowhere, Observer
from rodloop_cli.sweep.task import CLAIMS, Ending, Report, Task, failure

_ONE_AT_A_TIME = threading.Lock()
"""HDF5 must not be entered by two threads, and some executors run several tasks in a process."""


def run(task: Task) -> Report:
    """Run a member, unless another sweep has done so in the meantime or is just doing it.

    A member that fails is reported, not raised. Raises OSError if the folder cannot be written.
    """
    folder = Path(task.folder)
    with _ONE_AT_A_TIME, _claimed(folder, task.name) as is_ours:
        if not is_ours:
            return Report(Ending.is_busy)
        _ledger(folder).refresh()
        if _ledger(folder).is_done(task.name, task.key, keeps_fields=task.keeps_fields):
            return Report(Ending.was_done)
        _use_one_thread()
        row = _run(task)
        Manifest(folder).append(row)
        return Report(Ending.ran if status_of(row).is_done else Ending.failed, str(row["outcome"]))


@cache
def _use_one_thread() -> None:
    """Once a process: workers share the cores already, and the matrices are small."""
    threadpool_limits(1)


@contextmanager
def _claimed(folder: Path, name: str) -> Iterator[bool]:
    """Whether this process may run the member; the claim ends with the block, or with the process."""
    claim = _claim(folder / CLAIMS, name)
    try:
        yield claim is not None
    finally:
        if claim:
            claim.release()


def _claim(claims: Path, name: str) -> OutputLock | None:
    while True:
        claims.mkdir(exist_ok=True)
        try:
            return OutputLock(claims / name)
        except BlockingIOError:
            return None
        except FileNotFoundError:
            continue  # another sweep ended just now and removed the empty folder


@cache
def _ledger(folder: Path) -> Ledger:
    return Ledger(folder)


def _run(task: Task) -> Row:
    clock, processor = time.perf_counter(), time.process_time()
    known: Row = {"key": task.key, "member": task.name, "has_file": int(task.keeps_fields)}
    try:
        row = _simulated(task, known)
    except (RodloopError, OSError) as error:
        row = failure(task.name, task.key, " ".join(str(error).split()))
    except MemoryError:
        row = failure(task.name, task.key, "out of memory")
    except Exception as error:  # noqa: BLE001  a defect in one member must not cost the others
        row = failure(task.name, task.key, f"internal error: {type(error).__name__}: {error}")
    return row | {"wall_seconds": time.perf_counter() - clock, "cpu_seconds": time.process_time() - processor}


def _simulated(task: Task, known: Row) -> Row:
    run = Run.of(Case.model_validate(task.values))
    observer = Observer(Nowhere(), known, has_drag=run.case.zeta_perp > 0)
    try:
        if task.keeps_fields:
            _into_file(run, observer, Path(task.folder) / f"{task.name}.nc")
        else:
            run.into(observer, observer.reached)
    except ConvergenceError:
        # The row has the outcome, and what was computed is kept.
        return observer.row
    return observer.row


def _into_file(run: Run, observer: Observer, path: Path) -> None:
    recorder = run.recorder
    # A file of this name has other contents, or is a failed attempt: replaced when the new one is complete.
    with RunWriter(path, s=recorder.s, segment=recorder.segment, attributes=run.attributes, force=True) as writer:
        observer.sink = writer
        run.into(observer, observer.reached)
