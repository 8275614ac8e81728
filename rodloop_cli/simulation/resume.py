"""Taking a run up again: what the checkpoint holds beside the march, when it is written, and how a run is
interrupted.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

import numpy as np

from rodloop_cli.dataset.checkpoint import Arrays, load_checkpoint, remove_checkpoint, save_checkpoint
from rodloop_cli.dataset.provenance import versions
from rodloop_cli.dataset.writer import RunWriter
from rodloop_cli.errors import Interrupted
from rodloop_cli.march.memory import pack, unpack

if TYPE_CHECKING:
    from rodloop_cli.simulation.run import Run

FORMAT = 3
"""Of the arrays in a checkpoint: raised when they change, so that an older one is not taken for one of today."""

SECONDS_BETWEEN = 5.0
"""Between checkpoints: what a kill costs at most."""


class Keeper:
    """Writes checkpoints of a run beside its result, and ends it in good order when it is interrupted."""

    def __init__(self, writer: RunWriter, run: Run) -> None:
        self._writer, self._run = writer, run
        self._saved = time.monotonic()
        self.interrupted: str | None = None

    def after_step(self) -> None:
        """To be called between steps. Raises Interrupted, with the checkpoint written, if that was asked for."""
        if self.interrupted is None and time.monotonic() - self._saved < SECONDS_BETWEEN:
            return
        self._writer.flush()
        save_checkpoint(self._writer.path, run_key(self._run), packed(self._run, self._writer.rows))
        self._saved = time.monotonic()
        if self.interrupted is not None:
            reached = self._run.marcher.state.time
            raise Interrupted(
                f"{self.interrupted} at t = {reached:.4g}; the rows so far are in {self._writer.part}, "
                "continue with --resume"
            )

    def done(self) -> None:
        """The result is whole: the checkpoint has no use any more."""
        remove_checkpoint(self._writer.path)


@contextmanager
def signals_to(keeper: Keeper) -> Iterator[None]:
    """SIGINT and SIGTERM end the run after the present step; a second SIGINT ends it at once."""

    def ask(number: int, _: FrameType | None) -> None:
        if keeper.interrupted is not None:
            raise KeyboardInterrupt
        keeper.interrupted = "interrupted" if number == signal.SIGINT else "terminated"

    numbers = (signal.SIGINT, signal.SIGTERM)
    before = [signal.signal(number, ask) for number in numbers]
    try:
        yield
    finally:
        for number, handler in zip(numbers, before, strict=True):
            signal.signal(number, handler)


def run_key(run: Run) -> str:
    """What a checkpoint belongs to: the resolved case and the program that made it."""
    return f"{run.case.sha256} {FORMAT} {versions()}"


def resumed(output: Path, run: Run) -> int:
    """Put a fresh run where its checkpoint left it; the number of rows it had stored, 0 if there is none."""
    arrays = load_checkpoint(output, run_key(run))
    if arrays is None:
        return 0
    unpack(run.marcher, arrays)
    names = list(asdict(run.work))
    for name, value in zip(names, arrays["work"], strict=True):
        setattr(run.work, name, int(value))
    run.recorder.restore(arrays["recorder"])
    run.rest.slow = float(arrays["rest"][0])
    run.summary.amplification.restore(arrays["amplification"])
    extrema = run.summary.extrema
    extrema.minima = [(float(t), float(a)) for t, a in arrays["minima"]]
    extrema.maxima = [(float(t), float(a)) for t, a in arrays["maxima"]]
    extrema.sign, crossing, run.summary.spent = map(float, arrays["summary"])
    run.summary.first_crossing = None if np.isnan(crossing) else crossing
    return int(arrays["rows"][0])


def packed(run: Run, rows: int) -> Arrays:
    """The whole run as arrays."""
    summary = run.summary
    crossing = np.nan if summary.first_crossing is None else summary.first_crossing
    return pack(run.marcher) | {
        "work": np.array(list(asdict(run.work).values()), dtype=float),
        "recorder": run.recorder.memory(),
        "rest": np.array([run.rest.slow]),
        "amplification": summary.amplification.memory(),
        "minima": np.array(summary.extrema.minima).reshape(-1, 2),
        "maxima": np.array(summary.extrema.maxima).reshape(-1, 2),
        "summary": np.array([summary.extrema.sign, crossing, summary.seconds]),
        "rows": np.array([float(rows)]),
    }
