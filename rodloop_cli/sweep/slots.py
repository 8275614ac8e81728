"""An executor of processes in which a killed worker costs one task.

`concurrent.futures.ProcessPoolExecutor` breaks as a whole when a worker dies and cannot tell which task it was at. Here
each worker is alone at the end of a pipe, served by a thread of its own: its death is the failure of the task that it
had, and the next task gets a new process.
"""

from __future__ import annotations

import os
import queue
import signal
import threading
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from multiprocessing import get_context, parent_process
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""BLAS reads these when it is loaded: its threads are never made, not just left idle."""

_STARTING = threading.Lock()


class WorkerDied(BrokenExecutor):
    """The process that ran a task is gone."""


class ProcessSlots(Executor):
    """Runs tasks in ``count`` processes, which start with the first tasks and last until `shutdown`."""

    def __init__(self, count: int) -> None:
        self._jobs: queue.SimpleQueue[_Job | None] = queue.SimpleQueue()
        self._slots = [_Slot(self._jobs) for _ in range(count)]

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Have a function called in one of the processes; its result, or WorkerDied, is in the future."""
        future: Future[T] = Future()
        self._jobs.put(_Job(future, (fn, args, kwargs)))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the processes, when they have done what is queued or, with ``cancel_futures``, at once."""
        if cancel_futures:
            for slot in self._slots:
                slot.kill()
        for _ in self._slots:
            self._jobs.put(None)
        if wait:
            for slot in self._slots:
                slot.thread.join()


class _Job:
    def __init__(self, future: Future[Any], call: tuple[Any, ...]) -> None:
        self.future = future
        self.call = call


class _Slot:
    """A thread, and the process that it keeps at work."""

    def __init__(self, jobs: queue.SimpleQueue[_Job | None]) -> None:
        self._jobs = jobs
        self._process: BaseProcess | None = None
        self._pipe: Connection[Any, Any]
        self._is_killed = False
        self.thread = threading.Thread(target=self._serve, daemon=True)
        self.thread.start()

    def kill(self) -> None:
        """Stop the process with whatever it does; the slot takes no more tasks."""
        with _STARTING:
            self._is_killed = True
            if self._process:
                self._process.kill()

    def _serve(self) -> None:
        for job in iter(self._jobs.get, None):
            if self._is_killed or not job.future.set_running_or_notify_cancel():
                job.future.cancel()
                continue
            try:
                succeeded, result = self._answer(job.call)
            except (EOFError, OSError):
                succeeded, result = False, self._died()
            except Exception as error:  # noqa: BLE001  a call that cannot be sent belongs to the caller
                succeeded, result = False, error
            if succeeded:
                job.future.set_result(result)
            else:
                job.future.set_exception(result)
        self._end()

    def _answer(self, call: tuple[Any, ...]) -> tuple[bool, Any]:
        if self._process is None:
            self._start()
        self._pipe.send(call)
        answer: tuple[bool, Any] = self._pipe.recv()
        return answer

    def _start(self) -> None:
        with _STARTING:
            if self._is_killed:
                raise EOFError
            context = get_context("spawn")
            self._pipe, far_end = context.Pipe()
            self._process = context.Process(target=_work, args=(far_end,), daemon=True)
            kept = {name: os.environ.get(name) for name in _ONE_THREAD}
            os.environ.update(_ONE_THREAD)
            try:
                self._process.start()
            finally:
                _restore(kept)
            # Else the pipe would stay open when the process dies.
            far_end.close()

    def _died(self) -> WorkerDied:
        process, self._process = self._process, None
        if process is None:
            return WorkerDied("the worker process was stopped")
        process.join()
        self._pipe.close()
        return WorkerDied(f"the worker process died ({_how(process.exitcode)})")

    def _end(self) -> None:
        if self._process is not None:
            self._pipe.close()
            self._process.join()
            self._process.close()


def _restore(environment: dict[str, str | None]) -> None:
    for name, value in environment.items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value


def _how(exit_code: int | None) -> str:
    if exit_code is None or exit_code >= 0:
        return f"exit code {exit_code}"
    name = signal.Signals(-exit_code).name
    hint = ", perhaps out of memory" if -exit_code == getattr(signal, "SIGKILL", 0) else ""
    return f"{name}{hint}"


def _work(pipe: Connection[Any, Any]) -> None:
    """The life of a worker process: calls in, answers out, until the other end is closed."""
    # Ctrl-C reaches all processes of a terminal; what it means is up to the parent.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_exit_with_parent, daemon=True).start()
    while True:
        try:
            function, arguments, keywords = pipe.recv()
        except EOFError:
            return
        try:
            answer = True, function(*arguments, **keywords)
        except Exception as error:  # noqa: BLE001  it belongs to the caller
            answer = False, error
        pipe.send(answer)


def _exit_with_parent() -> None:
    """A parent that was killed must leave no workers behind, which would go on writing."""
    parent = parent_process()
    if parent is not None:
        wait([parent.sentinel])
        os._exit(1)
