"""YAML text to plain values, with the place of every key; a line and column for whatever is not YAML."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import yaml

from rodloop_cli.case.composer import Composer
from rodloop_cli.case.fault import Loc, Place, Problem
from rodloop_cli.case.wording import one_line
from rodloop_cli.errors import CaseError

SIZE_LIMIT = 1_000_000  # bytes


@dataclass(frozen=True)
class Document:
    """Plain values, where each was written, and what is wrong with the text already (repeated keys)."""

    name: str
    values: Any
    places: Mapping[Loc, Place]
    problems: tuple[Problem, ...] = ()

    def place(self, loc: Loc) -> Place:
        """The place of a key or list item, or of the closest thing around it that was written."""
        while loc and loc not in self.places:
            loc = loc[:-1]
        return self.places.get(loc) or Place(self.name, 1, 1)

    def part(self, loc: Loc) -> Document:
        """What lies under a key, as a document of its own (an inline ``base`` of a sweep file)."""
        values = self.values
        for step in loc:
            values = values[step]
        places = {key[len(loc) :]: place for key, place in self.places.items() if key[: len(loc)] == loc}
        return Document(self.name, values, places)


def read_document(text: str | bytes, name: str, *, lines: bool = True) -> Document:
    """Read one YAML document. ``lines=False`` for text that is not a file, such as the value of an override.

    Raises CaseError, with one line, for text that is not YAML or passes the limits.
    """
    decoded = _decoded(text, name, lines=lines)
    composer = Composer(name, lines=lines)
    values = composer.document(_events(decoded, name, lines=lines))
    return Document(name, values, composer.places, tuple(composer.problems))


def _decoded(text: str | bytes, name: str, *, lines: bool) -> str:
    if len(text) > SIZE_LIMIT:
        raise CaseError([f"{one_line(name)}: is larger than {SIZE_LIMIT} bytes, which no case file needs"])
    if isinstance(text, str):
        return text.removeprefix("\ufeff")
    try:
        return text.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        place = _position(name, text[: error.start].decode("utf-8", "replace"), lines=lines)
        what = f"is not UTF-8 text (byte 0x{text[error.start]:02x})"
        raise CaseError([str(Problem(place, what))]) from None


def _position(name: str, before: str, *, lines: bool) -> Place:
    """The place just after some text."""
    if not lines:
        return Place(name)
    return Place(name, before.count("\n") + 1, len(before) - before.rfind("\n"))


def _events(text: str, name: str, *, lines: bool) -> Iterator[Any]:
    try:
        yield from yaml.parse(text, Loader=yaml.SafeLoader)
    except yaml.reader.ReaderError as error:
        what = f"character #x{ord(text[error.position]):04x} is not allowed in YAML"
        raise CaseError([str(Problem(_position(name, text[: error.position], lines=lines), what))]) from None
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = Place(name, mark.line + 1, mark.column + 1) if mark and lines else Place(name)
        raise CaseError([str(Problem(place, _not_yaml(error.problem or error.context or "")))]) from None
    except (ValueError, OverflowError):
        # PyYAML lets escapes beyond Unicode ("\UFFFFFFFF") through, and version numbers of any length.
        what = _not_yaml("an escape code or a version number is out of range")
        raise CaseError([str(Problem(Place(name), what))]) from None


def _not_yaml(what: str) -> str:
    return f"not readable as YAML: {one_line(what)}"
