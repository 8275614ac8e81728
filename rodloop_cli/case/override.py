"""Single values set from outside a file: ``--set perturbation.0.amplitude=1e-3`` and the axes of a sweep."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from copy import deepcopy
from dataclasses import replace
from typing import Any

from rodloop_cli.case.fault import Loc, Place, Problem
from rodloop_cli.case.text import Document, read_document
from rodloop_cli.case.wording import dotted, one_line
from rodloop_cli.errors import CaseError

LONGEST_SOURCE = 60


def with_overrides(document: Document, overrides: Iterable[str]) -> Document:
    """The document with ``key=value`` texts applied in turn.

    The value is YAML; keys are dotted, list items counted from 0; an empty value removes the key. An override
    that cannot be applied becomes a problem of the document, to be reported with the others.
    """
    for text in overrides:
        document = _overridden(document, text)
    return document


def with_value(document: Document, key: str, value: Any, source: str) -> Document:
    """The document with one value set; ``source`` names it in messages. A value of None removes the key.

    Raises CaseError, with one line, if the key leads through something that is not there or holds no keys.
    """
    return _placed(document, key, value, {(): Place(one_line(source, LONGEST_SOURCE))})


def _overridden(document: Document, text: str) -> Document:
    source = f"--set {one_line(text, LONGEST_SOURCE)}"
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        return _noted(document, Problem(Place(source), "must be written key=value"))
    try:
        new = read_document(value, source, lines=False)
        document = replace(document, problems=(*document.problems, *new.problems))
        return _placed(document, key.strip(), new.values, new.places or {(): Place(source)})
    except CaseError as error:
        what = error.problems[0].removeprefix(f"{source}: ")
        return _noted(document, Problem(Place(source), what))


def _noted(document: Document, problem: Problem) -> Document:
    return replace(document, problems=(*document.problems, problem))


def _placed(document: Document, key: str, value: Any, places: Mapping[Loc, Place]) -> Document:
    values = deepcopy(document.values)
    source = places[()].source
    loc = _assign(values, key.split("."), value, source)
    kept = {old: place for old, place in document.places.items() if old[: len(loc)] != loc}
    # Mappings made on the way to the key were written by the same source.
    made = {loc[:depth]: places[()] for depth in range(1, len(loc)) if loc[:depth] not in kept}
    new = {(*loc, *inner): place for inner, place in places.items()}
    return replace(document, values=values, places={**kept, **made, **new})


def _assign(values: Any, steps: list[str], value: Any, source: str) -> Loc:
    """Sets the value in place, making the mappings on the way to it; returns the location."""
    loc: Loc = ()
    for step in steps[:-1]:
        index = _step(values, step, loc, source)
        if isinstance(values, dict):
            values.setdefault(index, {})
        values, loc = values[index], (*loc, index)
    last = _step(values, steps[-1], loc, source)
    if value is None and isinstance(values, dict):
        values.pop(last, None)
    else:
        values[last] = value
    return (*loc, last)


def _step(values: Any, step: str, loc: Loc, source: str) -> Any:
    """The key or index that a word of a dotted key stands for here."""
    if isinstance(values, dict) and step:
        return step
    if isinstance(values, list) and step.isascii() and step.isdigit() and int(step[:9]) < len(values):
        return int(step)
    if isinstance(values, list):
        items = f"items 0 to {len(values) - 1}" if values else "no items"
        raise CaseError([f"{source}: {dotted(loc)}: is a list with {items} (got '{one_line(step, 20)}')"])
    where = f"{dotted(loc)}: holds no keys" if loc else "is not a key"
    raise CaseError([f"{source}: {where} (got '{one_line(step, 20)}')"])
