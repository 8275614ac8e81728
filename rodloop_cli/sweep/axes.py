"""The axes of a sweep: lists of values for one key, or for several keys varied together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import Any

from rodloop_cli.case.fault import Loc, Place, Problem
from rodloop_cli.case.text import Document
from rodloop_cli.case.wording import abbreviated, did_you_mean, dotted

ZIP = "zip"
"""Name of the axis whose keys are varied together."""

MOST_POINTS = 100_000
SPACINGS = ("linspace", "logspace")

DIGITS = 14
"""Spaced values are rounded to so many: 0.3, not 0.30000000000000004, in file names, labels and content keys."""


@dataclass(frozen=True)
class Axis:
    """One dimension of the grid: at each point a value for each of its keys, and where they were written."""

    name: str
    keys: tuple[str, ...]
    points: tuple[tuple[Any, ...], ...]
    places: tuple[tuple[Place, ...], ...]

    def __len__(self) -> int:
        return len(self.points)

    @property
    def is_numeric(self) -> bool:
        """Whether it has one key whose values are numbers: its values then are a coordinate of the dataset."""
        return len(self.keys) == 1 and self.name != ZIP and all(is_number(point[0]) for point in self.points)


def is_number(value: Any) -> bool:
    """A whole or decimal number; not a truth value, which Python takes for one."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def axis_of(document: Document, loc: Loc, problems: list[Problem]) -> Axis | None:
    """The axis at a location such as ("grid", "p"); None, and the reasons in ``problems``, if it cannot be one."""
    raw = _at(document, loc)
    found = list(_faults(raw, loc))
    problems.extend(Problem(document.place(where), f"{dotted(where)}: {what}") for where, what in found)
    if found:
        return None
    key = str(loc[-1])
    values = _spaced(raw) if isinstance(raw, Mapping) else tuple(raw)
    places = tuple((document.place((*loc, i)),) for i in range(len(values)))
    return Axis(key, (key,), tuple((value,) for value in values), places)


def zipped(axes: list[Axis]) -> Axis:
    """Axes of equal length as one."""
    return Axis(
        ZIP,
        tuple(axis.keys[0] for axis in axes),
        tuple(zip(*([point[0] for point in axis.points] for axis in axes), strict=True)),
        tuple(zip(*([place[0] for place in axis.places] for axis in axes), strict=True)),
    )


def _at(document: Document, loc: Loc) -> Any:
    value = document.values
    for step in loc:
        value = value[step]
    return value


def _faults(raw: Any, loc: Loc) -> Iterator[tuple[Loc, str]]:
    """Everything that keeps a value from being an axis, with its location."""
    if isinstance(raw, Mapping):
        yield from _faults_of_spacing(raw, loc)
    elif not isinstance(raw, list):
        what = "must be a list, {linspace: [a, b, n]} or {logspace: [a, b, n]}"
        yield loc, f"{what} (got {abbreviated(raw)})"
    elif not raw:
        yield loc, "must not be empty; remove the key"
    else:
        yield from _faults_of_list(raw, loc)


def _faults_of_list(raw: list[Any], loc: Loc) -> Iterator[tuple[Loc, str]]:
    for i, value in enumerate(raw):
        if value is None:
            yield (*loc, i), "has no value; write one, or remove the item"
        # Only within one axis of the grid: values varied together may well repeat.
        elif loc[0] != ZIP and value in raw[:i]:
            yield (*loc, i), f"repeats an earlier value (got {abbreviated(value)})"


def _faults_of_spacing(raw: Mapping[str, Any], loc: Loc) -> Iterator[tuple[Loc, str]]:
    if len(raw) != 1:
        yield loc, f"must hold one of linspace and logspace (got {abbreviated(dict(raw))})"
        return
    kind, numbers = next(iter(raw.items()))
    if kind not in SPACINGS:
        yield (*loc, kind), f"unknown spacing, must be linspace or logspace{did_you_mean(kind, SPACINGS)}"
        return
    what = _fault_of_numbers(kind, numbers)
    if what:
        yield (*loc, kind), f"{what} (got {abbreviated(numbers)})"


def _fault_of_numbers(kind: str, numbers: Any) -> str:
    if not isinstance(numbers, list) or len(numbers) != 3 or not all(is_number(n) and isfinite(n) for n in numbers):
        return "must be three numbers, [first value, last value, number of values]"
    first, last, count = numbers
    if not isinstance(count, int) or not 2 <= count <= MOST_POINTS:
        return f"the number of values must be a whole number from 2 to {MOST_POINTS}"
    if first == last:
        return "the first and the last value must differ"
    return "the end values must both be positive or both negative" if kind == "logspace" and first * last <= 0 else ""


def _spaced(raw: Mapping[str, Any]) -> tuple[float, ...]:
    kind, (first, last, count) = next(iter(raw.items()))
    shares = [i / (count - 1) for i in range(count)]
    if kind == "linspace":
        values = [first + (last - first) * share for share in shares]
    else:
        values = [first * (last / first) ** share for share in shares]
    clean = [float(f"{value:.{DIGITS}g}") for value in values]
    # Whole numbers stay whole, for keys that take no others (N, snapshots).
    if isinstance(first, int) and isinstance(last, int) and all(value.is_integer() for value in clean):
        return tuple(int(value) for value in clean)
    return tuple(clean)
