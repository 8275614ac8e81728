"""The members of a sweep: made from the axes, every one checked before the first runs."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from hashlib import sha256
from typing import Any

from rodloop_cli import __version__
from rodloop_cli.case import Case, Document, case_from, with_value
from rodloop_cli.case.report import LONGEST_REPORT
from rodloop_cli.errors import CaseError
from rodloop_cli.sweep.axes import Axis
from rodloop_cli.sweep.cost import guessed_cost
from rodloop_cli.sweep.file import SweepFile
from rodloop_cli.sweep.naming import member_name

Index = tuple[int, ...]

_HERE = "axis"
"""Stands for the place of a value of an axis until the place itself is put in."""


@dataclass(frozen=True, slots=True)
class Member:
    """One point of the grid; ``key`` tells its content: the resolved case and the version of the program."""

    index: Index
    name: str
    key: str
    cost: float

    @property
    def file(self) -> str:
        """Name of its result file."""
        return f"{self.name}.nc"


@dataclass(frozen=True)
class Plan:
    """All members of a sweep in the order of the grid, or those of one shard of it."""

    sweep: SweepFile
    members: tuple[Member, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Points along each axis."""
        return tuple(len(axis) for axis in self.sweep.axes)

    def values(self, member: Member) -> dict[str, Any]:
        """The keys of its case file."""
        return _plain_values(self.sweep, member.index)


@dataclass(frozen=True)
class Shard:
    """Every count-th member from the number-th on, counted from 1: the share of one job of an array."""

    number: int = 1
    count: int = 1


def planned(sweep: SweepFile, shard: Shard | None = None) -> Plan:
    """Check every member, or those of the shard. Raises CaseError with everything that is wrong."""
    problems = dict.fromkeys(sweep.problems)
    _check_one_by_one(sweep, problems)
    if problems:
        raise CaseError(_report(list(problems)))
    part = shard or Shard()
    indices = itertools.islice(_indices(sweep.axes), part.number - 1, None, part.count)
    members = tuple(_members(sweep, indices, problems))
    if problems:
        raise CaseError(_report(list(problems)))
    return Plan(sweep, members)


def content_key(case: Case) -> str:
    """Hexadecimal sha256 of the resolved case and the program's version."""
    # Not from the YAML text of the case: that takes a millisecond, and there may be a million members.
    return sha256(json.dumps([__version__, case.resolved()], sort_keys=True).encode()).hexdigest()


def _indices(axes: tuple[Axis, ...]) -> Iterator[Index]:
    return itertools.product(*(range(len(axis)) for axis in axes))


def _check_one_by_one(sweep: SweepFile, problems: dict[str, None]) -> None:
    """Each value of each axis with the first values of the others: finds what is wrong with single values, once."""
    origin = (0,) * len(sweep.axes)
    indices = {
        (*origin[:i], point, *origin[i + 1 :]): None for i, axis in enumerate(sweep.axes) for point in range(len(axis))
    }
    for index in indices or {origin: None}:
        if len(problems) > LONGEST_REPORT:
            return
        problems.update(dict.fromkeys(_problems_of(sweep, index)))


def _problems_of(sweep: SweepFile, index: Index) -> list[str]:
    """What is wrong with a member, apart from the axes that could not be read."""
    if _case_or_none(sweep, index) is not None:
        return []
    try:
        case_from(_document(sweep, index))
    except CaseError as error:
        excused = tuple(f": {key}: is required but missing" for key in sweep.unread)
        return [line for line in error.problems if not line.endswith(excused)]
    return []


def _members(sweep: SweepFile, indices: Iterable[Index], problems: dict[str, None]) -> Iterator[Member]:
    names: dict[str, Index] = {}
    for index in indices:
        if len(problems) > LONGEST_REPORT:
            return
        case = _case_or_none(sweep, index)
        if case is None:
            problems.update(dict.fromkeys(_problems_of(sweep, index)))
            continue
        name = member_name(_varied(sweep.axes, index))
        if name in names:
            problems[f"{sweep.base.name}: two members would be called {name}; their values are too close"] = None
        names[name] = index
        yield Member(index, name, content_key(case), guessed_cost(case))


def _varied(axes: tuple[Axis, ...], index: Index) -> Iterator[tuple[str, Any]]:
    for axis, point in zip(axes, index, strict=True):
        yield from zip(axis.keys, axis.points[point], strict=True)


def _case_or_none(sweep: SweepFile, index: Index) -> Case | None:
    """The case of a member the fast way, None if there is anything to say about it."""
    if sweep.base.problems:
        return None
    try:
        return Case.model_validate(_plain_values(sweep, index))
    except (CaseError, ValueError):  # pydantic's error is a ValueError
        return None


def _plain_values(sweep: SweepFile, index: Index) -> dict[str, Any]:
    document = Document(sweep.base.name, sweep.base.values, {})
    for key, value in _varied(sweep.axes, index):
        document = with_value(document, key, value, _HERE)
    values: dict[str, Any] = document.values
    return values


def _document(sweep: SweepFile, index: Index) -> Document:
    """The member as a document in which every value is placed where the user wrote it."""
    document = sweep.base
    for axis, point in zip(sweep.axes, index, strict=True):
        for key, value, place in zip(axis.keys, axis.points[point], axis.places[point], strict=True):
            try:
                document = with_value(document, key, value, _HERE)
            except CaseError as error:
                raise CaseError([str(place) + line.removeprefix(_HERE) for line in error.problems]) from None
            places = {loc: place if old.source == _HERE else old for loc, old in document.places.items()}
            document = replace(document, places=places)
    return document


def _report(problems: list[str]) -> list[str]:
    more = len(problems) - LONGEST_REPORT
    return problems if more <= 0 else [*problems[:LONGEST_REPORT], "... and more problems"]
