"""What is wrong with a case, before it is written out: faults of values, places in the text, problems."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rodloop_cli.case.wording import one_line

#: Keys and list indices from the top of a document.
Loc = tuple[str | int, ...]


@dataclass(frozen=True)
class Fault:
    """One thing wrong with the values: where, what, the offending value, and a guess at what was meant.

    ``got`` is None where there is no offending value (a missing key) or it is not known (a broken key).
    """

    loc: Loc
    what: str
    got: Any = None
    hint: str = ""


@dataclass(frozen=True)
class Place:
    """Where a value was written: a position in a file, or an override, which has no lines."""

    source: str
    line: int = 0
    column: int = 0

    def __str__(self) -> str:
        return f"{self.source}:{self.line}:{self.column}" if self.line else self.source

    @property
    def order(self) -> tuple[bool, int, int]:
        """Sorts the places of a file from top to bottom, and overrides after them."""
        return (self.line == 0, self.line, self.column)


@dataclass(frozen=True)
class Problem:
    """One line of a report: a place, and what is wrong there."""

    place: Place
    what: str

    def __str__(self) -> str:
        return f"{one_line(str(self.place))}: {self.what}"
