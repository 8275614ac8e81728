"""YAML parser events to plain values; only mappings, lists and scalars can come out.

Text from strangers is read in bounded time and memory: the depth and the number of values are limited. Tags,
anchors and aliases, which case files have no use for, are refused.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NoReturn

import yaml

from rodloop_cli.case.fault import Loc, Place, Problem
from rodloop_cli.case.scalars import plain_value
from rodloop_cli.case.wording import dotted
from rodloop_cli.errors import CaseError

DEPTH_LIMIT = 20
VALUE_LIMIT = 20_000  # about a second of PyYAML


@dataclass
class Composer:
    """Builds values from parser events; counts and places them on the way."""

    name: str
    lines: bool
    places: dict[Loc, Place] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)
    count: int = 0

    def document(self, events: Iterator[Any]) -> Any:
        values: Any = None
        documents = 0
        for event in events:
            if isinstance(event, yaml.NodeEvent):
                documents += 1
                if documents > 1:
                    self.refuse(event, "holds a second YAML document; keep one")
                values = self.node(event, events, ())
        return values

    def node(self, event: Any, events: Iterator[Any], loc: Loc) -> Any:
        self.check(event, loc)
        self.places.setdefault(loc, self.place(event))
        if isinstance(event, yaml.MappingStartEvent):
            return self.mapping(events, loc)
        if isinstance(event, yaml.SequenceStartEvent):
            return self.sequence(events, loc)
        return self.scalar(event, loc)

    def mapping(self, events: Iterator[Any], loc: Loc) -> dict[str, Any]:
        result: dict[str, Any] = {}
        for event in events:
            if isinstance(event, yaml.MappingEndEvent):
                break
            key = self.key(event, loc)
            inner = (*loc, key)
            if key in result:
                first = f"first given in line {self.places[inner].line}" if self.lines else "given twice"
                self.problems.append(Problem(self.place(event), f"{dotted(inner)}: repeated key, {first}"))
            self.places[inner] = self.place(event)
            result[key] = self.node(next(events), events, inner)
        return result

    def sequence(self, events: Iterator[Any], loc: Loc) -> list[Any]:
        result: list[Any] = []
        for event in events:
            if isinstance(event, yaml.SequenceEndEvent):
                break
            result.append(self.node(event, events, (*loc, len(result))))
        return result

    def scalar(self, event: Any, loc: Loc) -> Any:
        if event.style is not None:
            return event.value
        try:
            return plain_value(event.value)
        except ValueError as error:
            self.refuse(event, f"{dotted(loc)}: {error}" if loc else str(error))

    def key(self, event: Any, loc: Loc) -> str:
        self.check(event, loc)
        if not isinstance(event, yaml.ScalarEvent):
            self.refuse(event, "a key must be a plain word, not a list or mapping")
        return str(event.value)

    def check(self, event: Any, loc: Loc) -> None:
        self.count += 1
        if isinstance(event, yaml.AliasEvent) or event.anchor is not None:
            self.refuse(event, "anchors (&) and aliases (*) are not supported; write the value, or quote it")
        if event.tag is not None:
            self.refuse(event, "tags (!) are not supported; write the plain value, or quote it")
        if self.count > VALUE_LIMIT:
            self.refuse(event, f"more than {VALUE_LIMIT} keys and values")
        if len(loc) > DEPTH_LIMIT:
            self.refuse(event, f"nested deeper than {DEPTH_LIMIT} levels")

    def place(self, event: Any) -> Place:
        mark = event.start_mark
        return Place(self.name, mark.line + 1, mark.column + 1) if self.lines else Place(self.name)

    def refuse(self, event: Any, what: str) -> NoReturn:
        raise CaseError([str(Problem(self.place(event), what))])
