"""What passes between the process that leads a sweep and its workers.

Light on purpose: the leading process starts workers before anything else, and never loads the solver itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import Any

from rodloop_cli.sweep.columns import Row, Status

CLAIMS = ".claims"
"""Folder of the locks that members are run under."""


@dataclass(frozen=True)
class Task:
    """Everything a worker needs to run a member; ``values`` are the keys of its case file."""

    folder: str
    name: str
    key: str
    values: dict[str, Any]
    keeps_fields: bool


class Ending(Enum):
    """What became of a task."""

    ran = auto()
    failed = auto()
    was_done = auto()
    is_busy = auto()


@dataclass(frozen=True)
class Report:
    """What a worker sends back; everything else is in the manifest."""

    ending: Ending
    outcome: str = ""


def failure(name: str, key: str, outcome: str) -> Row:
    """The row of a member that has no result."""
    return {"key": key, "member": name, "status": int(Status.failed), "outcome": outcome}
