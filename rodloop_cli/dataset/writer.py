"""The result file while a run goes on: rows streamed into OUT.nc.part, renamed to OUT.nc at the end.

Written with netCDF4 alone: xarray cannot append along an unlimited dimension and takes a second to import.
"""

from __future__ import annotations

import contextlib
import math
import os
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import TracebackType

import netCDF4
import numpy as np
import numpy.typing as npt

from rodloop_cli.dataset.failures import writing
from rodloop_cli.dataset.layout import BLOCK_ROWS, create_layout, row_bytes
from rodloop_cli.dataset.lock import OutputLock
from rodloop_cli.dataset.provenance import clean_attributes
from rodloop_cli.dataset.room import Room
from rodloop_cli.dataset.rows import Row, RowBlock
from rodloop_cli.dataset.variables import Attribute
from rodloop_cli.errors import OutputError

SYNC_SECONDS = 1.0
"""Longest time that a row waits in memory while rows or `flush_if_due` keep coming; a sync costs 3-5 ms."""


def part_path(output: Path) -> Path:
    """Where the rows are until the run is done."""
    return output.with_name(output.name + ".part")


class RunWriter:
    """Streams rows into `path`.part; `finish` turns it into `path`, anything else leaves the .part behind.

    `s` [S] in [0, 2 pi) and `segment` [S] (1, 2, ...) are the output points; `attributes` is what is known
    beforehand. Raises OutputError: at construction if `path` exists (without `force`), cannot be written or
    is being written by another run; later if the disk is full or the folder gone. A .part left by a killed
    run is replaced, or with `resume` carried on after that many of its rows. As a context manager it abandons a file
    that is not finished.
    """

    def __init__(
        self,
        path: str | os.PathLike[str],
        *,
        s: npt.NDArray[np.float64],
        segment: npt.NDArray[np.integer],
        attributes: Mapping[str, Attribute],
        force: bool = False,
        resume: int = 0,
    ) -> None:
        self.path = Path(path)
        self.part = part_path(self.path)
        self._force = force
        self._written = 0
        self._kept_until = math.nan
        self._block = RowBlock(len(s), BLOCK_ROWS)
        self._room = Room(self.path.parent)
        self._row_bytes = row_bytes(len(s))
        self._synced = time.monotonic()
        clean = clean_attributes(attributes)
        check_target(self.path, force=force)
        self._lock = self._take_lock()
        try:
            self._dataset: netCDF4.Dataset | None = (
                self._reopen(resume, clean) if resume else self._create(s, segment, clean)
            )
        except BaseException:
            self._lock.release()
            raise

    def append(self, row: Row) -> None:
        """Take one stored time: on disk at once if it is the first, else within `SYNC_SECONDS` or a block."""
        self._block.put(row)
        block_ends = (self._written + self._block.count) % BLOCK_ROWS == 0
        if self._written == 0 or block_ends or self._block.full:
            self.flush()
        else:
            self.flush_if_due()

    @property
    def rows(self) -> int:
        """Number of rows taken so far."""
        return self._written + self._block.count

    def stored(self) -> Iterator[tuple[float, npt.NDArray[np.float64]]]:
        """Time and curvature [S] of the rows that a continued run found here, those that cross left out."""
        variables = self._open_dataset().variables
        for i in range(self._written):
            if not variables["crossing"][i]:
                yield float(variables["t"][i]), np.asarray(variables["curvature"][i])

    def flush_if_due(self) -> None:
        """Bring rows to disk if they have waited long; costs nothing otherwise. For loops between rows."""
        if self._block.count and time.monotonic() - self._synced > SYNC_SECONDS:
            self.flush()

    def flush(self) -> None:
        """Bring all rows to disk, so that a killed process loses none of them."""
        if not self._block.count:
            return
        with writing(self.part, self._kept):
            self._room.take(self._block.count * self._row_bytes)
            self._write_block(self._open_dataset())
        self._kept_until = self._block.last_time
        self._synced = time.monotonic()
        # No call between these two: Ctrl-C cannot fall between them and make `abandon` store rows twice.
        self._written += self._block.count
        self._block.count = 0

    def finish(self, attributes: Mapping[str, Attribute]) -> None:
        """Write what is left and `attributes`, those known at the end; close and rename to `path`."""
        self.flush()
        with writing(self.part, self._kept):
            self._open_dataset().setncatts(clean_attributes(attributes))
            self._close()
        if self.path.exists() and not self._force:
            raise OutputError(f"{self.path} appeared during the run; the whole result is in {self.part}")
        with writing(self.part, self._kept):
            self.part.replace(self.path)
        self._lock.release()

    def abandon(self) -> None:
        """Close, keep the .part with every row so far, or remove it if it has none. Raises no OutputError."""
        if self._dataset is not None:
            with contextlib.suppress(OutputError):
                self.flush()
            with contextlib.suppress(OSError, RuntimeError):
                self._close()
            if not self._written:
                _remove(self.part)
        self._lock.release()

    def __enter__(self) -> RunWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.abandon()

    def _take_lock(self) -> OutputLock:
        with writing(self.part, self._kept):
            try:
                return OutputLock(self.path)
            except BlockingIOError:
                message = f"{self.path} is being written by another run; wait for it or choose another name"
                raise OutputError(f"{message} with -o") from None

    def _create(
        self,
        s: npt.NDArray[np.float64],
        segment: npt.NDArray[np.integer],
        attributes: Mapping[str, Attribute],
    ) -> netCDF4.Dataset:
        with writing(self.part, self._kept):
            self._room.take(0)
            # A damaged one that `resume` could not open stays open inside HDF5: the new file is another one.
            _remove(self.part)
            dataset = netCDF4.Dataset(self.part, "w", format="NETCDF4")
            try:
                create_layout(dataset, s, segment, attributes)
            except BaseException:
                with contextlib.suppress(OSError, RuntimeError):
                    dataset.close()
                _remove(self.part)
                raise
        return dataset

    def _reopen(self, rows: int, attributes: Mapping[str, Attribute]) -> netCDF4.Dataset:
        """The .part of a killed run, to go on after `rows` rows; later ones are the same and written once more."""
        dataset = None
        try:
            dataset = netCDF4.Dataset(self.part, "a")
            times = np.asarray(dataset.variables["t"][:rows])
            same = dataset.getncattr("case_sha256") == attributes["case_sha256"]
        except (OSError, RuntimeError, LookupError, AttributeError):
            if dataset is not None:  # HDF5 would keep its lock on it
                with contextlib.suppress(OSError, RuntimeError):
                    dataset.close()
            raise OutputError(f"{self.part} cannot be continued; run again without --resume") from None
        if not same or len(times) < rows:
            dataset.close()
            raise OutputError(f"{self.part} does not belong to this case; run again without --resume")
        self._written, self._kept_until = rows, float(times[-1])
        self._block.continue_after(float(times[-1]))
        return dataset

    def _write_block(self, dataset: netCDF4.Dataset) -> None:
        rows = slice(self._written, self._written + self._block.count)
        for variable, values in self._block.columns():
            dataset.variables[variable.name][rows] = values
        dataset.sync()

    def _open_dataset(self) -> netCDF4.Dataset:
        if self._dataset is None:
            raise ValueError(f"{self.path}: the file is closed")
        return self._dataset

    def _close(self) -> None:
        dataset, self._dataset = self._open_dataset(), None
        dataset.close()

    def _kept(self) -> str:
        return f"; the rows up to t = {self._kept_until:.6g} are in {self.part.name}" if self._written else ""


def check_target(path: Path, *, force: bool) -> None:
    """Refuse a `path` in no folder, one that is a folder, and without `force` one that exists."""
    if not path.parent.is_dir():
        raise OutputError(f"{path}: no folder {path.parent}; create it or choose another place with -o")
    if path.is_dir():
        raise OutputError(f"{path} is a folder; name a file in it with -o")
    if path.exists() and not force:
        raise OutputError(f"{path} exists; replace it with --force or choose another name with -o")


def _remove(path: Path) -> None:
    with contextlib.suppress(OSError):
        path.unlink()
