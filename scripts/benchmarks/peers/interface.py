"""What a peer looks like from outside."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import product
from typing import Any

from scripts.references.observables import Row

Settings = Mapping[str, Any]
Solve = Callable[..., "Outcome"]


@dataclass
class Outcome:
    """Wall seconds of set-up and integration (no imports, no compilation, no observables), and what came out.

    alone: where ``wall`` holds more than that, what is left without it.
    """

    wall: float
    rows: list[Row]
    notes: str = ""
    alone: float | None = None


@dataclass(frozen=True)
class Peer:
    """``solve(problem, **settings)``; ``settings``: the list to scan by case; ``limit``: what bounds the error."""

    name: str
    solve: Solve
    settings: Mapping[str, list[dict[str, Any]]]
    limit: str


class Clock:
    """Elapsed wall seconds."""

    def __init__(self) -> None:
        self.seconds = 0.0


@contextmanager
def timed() -> Iterator[Clock]:
    clock, begin = Clock(), time.perf_counter()
    try:
        yield clock
    finally:
        clock.seconds = time.perf_counter() - begin


def grid_of(**lists: list[Any]) -> list[dict[str, Any]]:
    """Every combination of the listed settings."""
    return [dict(zip(lists, values, strict=True)) for values in product(*lists.values())]
