"""Checks a document against a pydantic model; says all that is wrong, a plain line each, with its place."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from rodloop_cli.case.fault import Fault, Loc, Problem
from rodloop_cli.case.locate import document_loc, known_keys
from rodloop_cli.case.text import Document
from rodloop_cli.case.wording import abbreviated, did_you_mean, dotted
from rodloop_cli.errors import CaseError

Model = TypeVar("Model", bound=BaseModel)
Rules = Callable[[Mapping[str, Any]], Iterator[Fault]]
Error = Mapping[str, Any]  # pydantic's, from ValidationError.errors()

#: A file of nothing but mistakes must not fill the screen.
LONGEST_REPORT = 50

_WORDS = {
    "missing": "is required but missing",
    "float_type": "must be a number",
    "int_type": "must be a whole number",
    "string_type": "must be text; put it in quotes",
    "string_unicode": "must be text without lone surrogates",
    "string_pattern_mismatch": "must be one line without control characters",
    "string_too_long": "must have at most {max_length} characters",
    "tuple_type": "must be a list, in square brackets or one '- item' a line",
    "model_type": "must be a mapping, {{key: value, ...}}",
    "finite_number": "must be a finite number",
    "greater_than": "must be greater than {gt:.10g}",
    "greater_than_equal": "must be at least {ge:.10g}",
    "less_than": "must be less than {lt:.10g}",
    "less_than_equal": "must be at most {le:.10g}",
    "too_long": "must have at most {max_length} entries",
}


def validated(model: type[Model], document: Document, rules: Rules | None = None) -> Model:
    """The document as a model.

    ``rules`` between keys, which the model itself applies once each key is valid, are used here for the valid
    keys of a document that has broken ones.
    Raises CaseError with every problem, in the order of the file.
    """
    values = document.values
    if not isinstance(values, dict):
        what = "holds no keys" if values is None else f"must be lines of 'key: value' (got {abbreviated(values)})"
        raise CaseError(report([*document.problems, Problem(document.place(()), what)]))
    result, faults = _attempt(model, values, rules)
    problems = [*document.problems, *(_problem(document, fault) for fault in faults)]
    if result is None or problems:
        raise CaseError(report(problems))
    return result


def report(problems: Sequence[Problem]) -> list[str]:
    """The problems as lines, from the top of the file to its end, overrides last."""
    lines = [str(problem) for problem in sorted(problems, key=lambda problem: problem.place.order)]
    more = len(lines) - LONGEST_REPORT
    return lines if more <= 0 else [*lines[:LONGEST_REPORT], f"... and {more} more problems"]


def _attempt(model: type[Model], values: dict[str, Any], rules: Rules | None) -> tuple[Model | None, list[Fault]]:
    """The model, or the faults that keep it from being one; both if an empty value passes as None."""
    empty = list(_empty_values(values))
    try:
        return model.model_validate(values), empty
    except ValidationError as refused:
        errors = refused.errors(include_url=False)
    faults = empty + [fault for error in errors for fault in _fault(model, error) if not _inside(fault.loc, empty)]
    if rules and any(error["type"] != "rule" for error in errors):
        faults += [fault for fault in rules(_given(values, faults)) if not _inside(fault.loc, faults)]
    return None, faults


def _given(values: dict[str, Any], faults: Sequence[Fault]) -> dict[str, Any]:
    """The values with None for the keys that are broken."""
    broken = {fault.loc[0] for fault in faults if fault.loc}
    return {key: None if key in broken else value for key, value in values.items()}


def _inside(loc: Loc, faults: Sequence[Fault]) -> bool:
    return any(loc[: len(fault.loc)] == fault.loc for fault in faults)


def _empty_values(value: Any, loc: Loc = ()) -> Iterator[Fault]:
    if value is None:
        yield Fault(loc, "has no value; write one, or remove the key")
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for step, inner in items:
        yield from _empty_values(inner, (*loc, step))


def _fault(model: type[BaseModel], error: Error) -> Iterator[Fault]:
    """A pydantic error in plain words."""
    kind, got = error["type"], error["input"]
    loc = error["loc"] if kind == "rule" else document_loc(model, error["loc"])
    if kind == "default_factory_not_called":
        return  # a default that depends on a broken key is no error of its own
    if kind == "extra_forbidden":
        yield _unknown(loc, got, known_keys(model, error["loc"][:-1]))
    elif kind == "literal_error":
        choices = re.findall(r"'([^']*)'", error["ctx"]["expected"])
        yield Fault(loc, f"must be {' or '.join(choices)}", got, did_you_mean(str(got), choices))
    elif kind == "missing":
        yield Fault(loc, _WORDS[kind])
    else:
        yield Fault(loc, _WORDS[kind].format(**error.get("ctx", {})) if kind in _WORDS else error["msg"], got)


def _unknown(loc: Loc, got: Any, choices: Sequence[str]) -> Fault:
    key = str(loc[-1])
    if key in choices:  # of the other kind of a union
        return Fault(loc, "does not go with the other keys here", got)
    return Fault(loc, "unknown key", got, did_you_mean(key, choices))


def _problem(document: Document, fault: Fault) -> Problem:
    subject = f"{dotted(fault.loc)}: " if fault.loc else ""
    # A rule may meet a key whose own value is broken, hence unknown to it.
    got = "" if fault.got is None else f" (got {abbreviated(fault.got)})"
    return Problem(document.place(fault.loc), f"{subject}{fault.what}{got}{fault.hint}")
