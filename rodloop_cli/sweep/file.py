"""The sweep file: a base case, the axes over which it is varied, what to keep of each member."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Any

from rodloop_cli.case import Case, Document, open_document, with_overrides
from rodloop_cli.case.fault import Loc, Problem
from rodloop_cli.case.wording import abbreviated, did_you_mean, dotted
from rodloop_cli.errors import CaseError
from rodloop_cli.sweep.axes import ZIP, Axis, axis_of, zipped

KEYS = ("base", "grid", ZIP, "output")
OUTPUTS = ("fields", "scalars")

MOST_MEMBERS = 10_000_000
"""A limit against slips of the pen; ten times the largest sweep that was planned for."""


@dataclass(frozen=True)
class SweepFile:
    """What a sweep file says, as far as it can be read; ``problems`` holds the rest, one line each.

    ``unread`` are the keys that were meant as axes but could not be read: a case without them is no problem.
    """

    base: Document
    axes: tuple[Axis, ...]
    keeps_fields: bool
    problems: tuple[str, ...]
    unread: tuple[str, ...]


def read_sweep(path: str, overrides: Iterable[str] = ()) -> SweepFile:
    """Read a sweep file and its base.

    ``overrides`` are ``key=value`` texts for keys of the base case, or of the sweep file (``grid.p=[1, 2]``).
    Raises CaseError if one of the two files cannot be read at all.
    """
    own, of_base = _parted(overrides)
    document = with_overrides(open_document(path), own)
    if not isinstance(document.values, dict):
        what = f"must be lines of 'key: value' with base and grid (got {abbreviated(document.values)})"
        raise CaseError([str(Problem(document.place(()), what))])
    problems = [*document.problems, *_unknown_keys(document)]
    axes, unread = _axes(document, problems)
    keeps_fields = _output(document, problems) == "fields"
    try:
        base = with_overrides(_base(document, Path(path).parent), of_base)
    except CaseError as error:
        raise CaseError([*_lines(problems), *error.problems]) from None
    return SweepFile(base, tuple(axes), keeps_fields, tuple(_lines(problems)), tuple(unread))


def _parted(overrides: Iterable[str]) -> tuple[list[str], list[str]]:
    """Overrides of the sweep file itself, and those of its base."""
    own: list[str] = []
    of_base: list[str] = []
    for text in overrides:
        first = text.partition("=")[0].partition(".")[0].strip()
        (own if first in KEYS else of_base).append(text)
    return own, of_base


def _lines(problems: list[Problem]) -> list[str]:
    return [str(problem) for problem in sorted(problems, key=lambda problem: problem.place.order)]


def _unknown_keys(document: Document) -> list[Problem]:
    return [
        Problem(document.place((key,)), f"{dotted([key])}: unknown key in a sweep file{_hint(key)}")
        for key in document.values
        if key not in KEYS
    ]


def _hint(key: str) -> str:
    if key in case_keys():
        return "; a key of the case belongs in base, or in grid with a list of values"
    return did_you_mean(key, KEYS)


def case_keys() -> list[str]:
    """The keys that a case file may have."""
    return [info.alias or name for name, info in Case.model_fields.items()]


def _base(document: Document, folder: Path) -> Document:
    raw = document.values.get("base")
    if isinstance(raw, dict):
        return document.part(("base",))
    if isinstance(raw, str):
        return open_document(folder / raw)
    what = "base: is required but missing" if raw is None else "base: must be the path of a case file, or a mapping"
    got = "" if raw is None else f" (got {abbreviated(raw)})"
    raise CaseError([str(Problem(document.place(("base",)), what + got))])


def _output(document: Document, problems: list[Problem]) -> str:
    output = document.values.get("output", OUTPUTS[0])
    if output in OUTPUTS:
        return str(output)
    hint = did_you_mean(str(output), OUTPUTS)
    what = f"output: must be fields or scalars (got {abbreviated(output)}){hint}"
    problems.append(Problem(document.place(("output",)), what))
    return OUTPUTS[0]


def _axes(document: Document, problems: list[Problem]) -> tuple[list[Axis], list[str]]:
    """The axes that can be read, and the keys of those that cannot."""
    before = len(problems)
    axes, unread = _grid(document, "grid", problems)
    together, unread_together = _grid(document, ZIP, problems)
    _check_apart(document, axes, together, problems)
    if together and _equally_long(document, together, problems):
        axes.append(zipped(together))
    elif together:
        unread_together += [axis.name for axis in together]
    if len(problems) == before:
        _check_size(document, axes, problems)
    return axes, [*unread, *unread_together]


def _grid(document: Document, part: str, problems: list[Problem]) -> tuple[list[Axis], list[str]]:
    raw: Any = document.values.get(part, {})
    if not isinstance(raw, dict):
        what = f"{part}: must be a mapping of keys to values (got {abbreviated(raw)})"
        problems.append(Problem(document.place((part,)), what))
        return [], []
    axes: list[Axis] = []
    unread: list[str] = []
    for key in raw:
        loc: Loc = (part, key)
        axis = axis_of(document, loc, problems) if _is_case_key(document, loc, problems) else None
        if axis is None:
            unread.append(key)
        else:
            axes.append(axis)
    return axes, unread


def _is_case_key(document: Document, loc: Loc, problems: list[Problem]) -> bool:
    first = str(loc[-1]).partition(".")[0]
    if first in case_keys():
        return True
    what = f"{dotted(loc)}: not a key of a case{did_you_mean(first, case_keys())}"
    problems.append(Problem(document.place(loc), what))
    return False


def _check_apart(document: Document, axes: list[Axis], together: list[Axis], problems: list[Problem]) -> None:
    for axis in together:
        if any(axis.name == other.name for other in axes):
            what = f"zip.{axis.name}: is varied by grid as well; remove one of the two"
            problems.append(Problem(document.place((ZIP, axis.name)), what))


def _equally_long(document: Document, together: list[Axis], problems: list[Problem]) -> bool:
    wrong = [axis for axis in together if len(axis) != len(together[0])]
    for axis in wrong:
        what = f"zip.{axis.name}: must have as many values as {together[0].name}, {len(together[0])} (got {len(axis)})"
        problems.append(Problem(document.place((ZIP, axis.name)), what))
    return not wrong


def _check_size(document: Document, axes: list[Axis], problems: list[Problem]) -> None:
    count = prod(len(axis) for axis in axes)
    if not axes:
        problems.append(Problem(document.place(()), "grid: is required but missing (or zip)"))
    elif count > MOST_MEMBERS:
        what = f"grid: has {count} members, more than {MOST_MEMBERS}"
        problems.append(Problem(document.place(("grid",)), what))
