"""Where a pydantic error belongs in a document, and which keys may stand there."""

from __future__ import annotations

from typing import Any, get_args

from pydantic import BaseModel

from rodloop_cli.case.fault import Loc

Models = list[type[BaseModel]]


def document_loc(model: type[BaseModel], steps: Loc) -> Loc:
    """A location as pydantic gives it, in keys and list indices of the document."""
    return _walk(model, steps)[0]


def known_keys(model: type[BaseModel], steps: Loc) -> list[str]:
    """The keys of whatever models may stand at a location as pydantic gives it."""
    models = _walk(model, steps)[1]
    return [info.alias or name for each in models for name, info in each.model_fields.items()]


def _walk(model: type[BaseModel], steps: Loc) -> tuple[Loc, Models]:
    loc: Loc = ()
    models = [model]
    is_choice = False
    for step in steps:
        if is_choice:
            # After the index of an item that may be one of several models, pydantic names the one it took.
            is_choice = False
            continue
        loc = (*loc, step)
        if isinstance(step, str):
            models = [inner for outer in models for inner in _models_in(_annotation(outer, step))]
        is_choice = isinstance(step, int) and len(models) > 1
    return loc, models


def _annotation(model: type[BaseModel], key: str) -> Any:
    for name, info in model.model_fields.items():
        if key == (info.alias or name):
            return info.annotation
    return None


def _models_in(annotation: Any) -> Models:
    """The models inside a list, an alternative or an annotated type."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for inner in get_args(annotation) for model in _models_in(inner)]
