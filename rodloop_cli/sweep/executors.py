"""Who runs the members: processes here, a dask cluster, MPI ranks."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass

from rodloop_cli.errors import OutputError
from rodloop_cli.sweep.slots import ProcessSlots

QUEUED = 2
"""Tasks handed out for each remote worker: one to work at, one on the way."""


@dataclass(frozen=True)
class Crew:
    """An executor, and how many tasks it should have at a time."""

    executor: Executor
    tasks: int


@contextmanager
def crew(kind: str | Executor, processes: int, scheduler: str | None) -> Iterator[Crew]:
    """The executor of a kind; what it started is stopped at the end, at once if that is an exception.

    An executor that is given is used as it is, with ``processes`` tasks at a time, and left to its owner.
    """
    if isinstance(kind, Executor):
        yield Crew(kind, processes)
        return
    hire = {"process": lambda: _processes(processes), "dask": lambda: _dask(scheduler), "mpi": _mpi}[kind]
    with hire() as hired:
        yield hired


@contextmanager
def _processes(count: int) -> Iterator[Crew]:
    slots = ProcessSlots(count)
    try:
        yield Crew(slots, count)
    except BaseException:
        slots.shutdown(cancel_futures=True)
        raise
    slots.shutdown()


def check_scheduler(kind: str | Executor, scheduler: str | None) -> None:
    """Raises OutputError if dask is asked for and nobody said where it is."""
    if kind == "dask" and not scheduler:
        raise OutputError("--executor dask needs the address of a scheduler: --scheduler tcp://host:8786")


@contextmanager
def _dask(scheduler: str | None) -> Iterator[Crew]:
    try:
        from distributed import Client  # noqa: PLC0415
    except ModuleNotFoundError:
        raise OutputError("--executor dask needs dask.distributed: pip install 'rodloop[dask]'") from None
    try:
        client = Client(scheduler, timeout=10)
    except (OSError, ValueError) as error:
        raise OutputError(f"no dask scheduler at {scheduler} ({error})") from None
    with client:
        threads = sum(client.nthreads().values())
        # Not pure: a failed member that is tried again must not be answered from memory.
        executor = client.get_executor(pure=False, retries=0)
        with _stopped_at_once(executor):
            yield Crew(executor, QUEUED * max(1, threads))


@contextmanager
def _mpi() -> Iterator[Crew]:
    try:
        from mpi4py.futures import MPIPoolExecutor  # noqa: PLC0415
    except (ImportError, RuntimeError) as error:
        remedy = f"pip install 'rodloop[mpi]' ({error})"
        raise OutputError(f"--executor mpi needs mpi4py and an MPI library: {remedy}") from None
    executor = MPIPoolExecutor()
    with _stopped_at_once(executor):
        yield Crew(executor, QUEUED * max(1, executor.num_workers))


@contextmanager
def _stopped_at_once(executor: Executor) -> Iterator[None]:
    """Wait for nothing after an exception such as Ctrl-C; remote workers may be at long tasks."""
    try:
        yield
    except BaseException:
        executor.shutdown(wait=False)
        raise
    executor.shutdown()
