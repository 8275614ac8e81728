"""Rows on their way to a file or to memory: one place that checks them and packs them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Protocol

import numpy as np
import numpy.typing as npt

from rodloop_cli.dataset.variables import IN_A_ROW, PROFILES, SCALARS, TIME, Attribute, Variable

Row = Mapping[str, npt.ArrayLike]
"""One stored time: a number for "t" and for each variable on (t), an array [S] for each one on (t, s)."""

_NAMES = frozenset(variable.name for variable in IN_A_ROW)
_NUMBERS = (*SCALARS, TIME)


class RowSink(Protocol):
    """Where a run puts its rows; a file (`RunWriter`) or memory (`MemoryRows`)."""

    def append(self, row: Row) -> None:
        """Take one stored time."""

    def flush_if_due(self) -> None:
        """To be called now and then while no row is ready; cheap."""

    def finish(self, attributes: Mapping[str, Attribute]) -> None:
        """Add the attributes known at the end (outcome, totals) and close."""


class RowBlock:
    """Rows waiting to be written.

    Held as numbers [capacity, scalars + 1], time last, and profiles [capacity, profiles, S]: one array for
    all profiles makes the copy and the finiteness check cheap. Rows are checked here, at the boundary: a NaN
    or a missing variable is a defect of the program and raises ValueError.
    """

    def __init__(self, points: int, capacity: int) -> None:
        self._numbers = np.empty((capacity, len(_NUMBERS)))
        self._profiles = np.empty((capacity, len(PROFILES), points))
        self._last_time = -math.inf
        self.count = 0

    def continue_after(self, time: float) -> None:
        """Expect rows later than this time only."""
        self._last_time = time

    @property
    def full(self) -> bool:
        return self.count == len(self._numbers)

    @property
    def last_time(self) -> float:
        """Time of the latest row ever put in, -inf before the first."""
        return self._last_time

    def put(self, row: Row) -> None:
        """Check and copy one row; a row that is refused leaves no trace."""
        if row.keys() != _NAMES:
            raise ValueError(f"a row must hold exactly the table's variables; {_difference(row)}")
        numbers, profiles = self._numbers[self.count], self._profiles[self.count]
        for column, variable in enumerate(_NUMBERS):
            numbers[column] = row[variable.name]
        for column, variable in enumerate(PROFILES):
            profiles[column] = row[variable.name]
        self._check(numbers, profiles)
        self._last_time = float(numbers[-1])
        self.count += 1

    def columns(self) -> Iterator[tuple[Variable, npt.NDArray[np.generic]]]:
        """Each variable of `IN_A_ROW`, time last, values [count] or [count, S] in the file's type."""
        for column, variable in enumerate(PROFILES):
            yield variable, self._profiles[: self.count, column].astype(variable.dtype)
        for column, variable in enumerate(_NUMBERS):
            yield variable, self._numbers[: self.count, column].astype(variable.dtype)

    def grow(self) -> None:
        """Double the capacity, keeping the rows."""
        self._numbers = np.concatenate([self._numbers, np.empty_like(self._numbers)])
        self._profiles = np.concatenate([self._profiles, np.empty_like(self._profiles)])

    def _check(self, numbers: npt.NDArray[np.float64], profiles: npt.NDArray[np.float64]) -> None:
        if not (np.isfinite(numbers).all() and np.isfinite(profiles).all()):
            raise ValueError(f"row at t = {numbers[-1]:.6g}: {_not_finite(numbers, profiles)} not finite")
        if numbers[-1] <= self._last_time:
            raise ValueError(f"row at t = {numbers[-1]:.6g} after the one at t = {self._last_time:.6g}")


def _difference(row: Row) -> str:
    missing, unknown = sorted(_NAMES - row.keys()), sorted(row.keys() - _NAMES)
    return f"missing {missing}, unknown {unknown}"


def _not_finite(numbers: npt.NDArray[np.float64], profiles: npt.NDArray[np.float64]) -> str:
    bad = [v.name for v, value in zip(_NUMBERS, numbers, strict=True) if not np.isfinite(value)]
    bad += [v.name for v, values in zip(PROFILES, profiles, strict=True) if not np.isfinite(values).all()]
    return ", ".join(bad) + (" is" if len(bad) == 1 else " are")
