"""Every error a user can meet, with the exit code the command line ends with."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar


class RodloopError(Exception):
    """Base of the errors that are answers rather than bugs; the text says what is wrong and what to do."""

    exit_code: ClassVar[int] = 1

    @property
    def lines(self) -> list[str]:
        """What to show the user, one message a line."""
        return str(self).splitlines()


class CaseError(RodloopError):
    """A case or sweep file (or an override of it) that is not valid: all its problems at once."""

    exit_code = 2

    def __init__(self, problems: Sequence[str]) -> None:
        """``problems``: complete one-line messages, as ``case.yaml:3:1: p: must be a number (got true)``."""
        super().__init__(list(problems))
        self.problems = tuple(problems)

    def __str__(self) -> str:
        return "\n".join(self.problems)

    @property
    def lines(self) -> list[str]:
        return list(self.problems)


class OutputError(RodloopError):
    """A result file or folder that is refused, or cannot be written or read."""

    exit_code = 2


class ConvergenceError(RodloopError):
    """The solver gave up; everything computed so far is kept."""

    exit_code = 3


class SweepError(RodloopError):
    """A sweep that ended with failed members; the others are kept."""

    exit_code = 4


class Interrupted(RodloopError):
    """Stopped by the user; the text says what is kept and how to go on."""

    exit_code = 130


class SingularSystem(ConvergenceError):
    """A linear system of the solver that cannot be factored; the time loop answers with a smaller step."""
