"""How a command ends: the exit code, and the lines that go to stderr."""

from __future__ import annotations

import errno
import os
import sys
import traceback
from collections.abc import Callable
from contextlib import suppress

import click

from rodloop_cli.cli.lazy import ReaderGone
from rodloop_cli.cli.settings import Settings
from rodloop_cli.errors import CaseError, Interrupted, OutputError, RodloopError


def exit_code(command: Callable[[], object], settings: Settings) -> int:
    """Runs the command to its end, whatever that is; 0 if it returns."""
    try:
        result = command()
        sys.stdout.flush()
    except (KeyboardInterrupt, click.Abort):
        return _told(Interrupted("interrupted"))
    except (ReaderGone, BrokenPipeError):
        return _silenced()
    except RodloopError as error:
        return _told(error)
    except click.ClickException as error:
        error.show()
        return CaseError.exit_code
    except Exception as error:  # noqa: BLE001 - the last resort: a user gets a line, not a traceback
        refusal = _refusal(error)
        return _told(refusal) if refusal else _unexpected(error, settings)
    return result if isinstance(result, int) else 0


def _told(error: RodloopError) -> int:
    for line in error.lines:
        click.echo(line, err=True)
    return error.exit_code


def _silenced() -> int:
    """Nobody reads stdout: point it at nothing, or Python complains when it flushes on the way out."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return ReaderGone.exit_code


def _refusal(error: Exception) -> OutputError | None:
    """A file that the system does not give, its name being too long or its folder closed, is an answer and no bug."""
    if isinstance(error, OSError) and error.errno == errno.ENOSPC and not error.filename:
        return OutputError("what is printed cannot be written: no space left where it goes")
    if not isinstance(error, OSError) or not isinstance(error.filename, str) or not error.strerror:
        return None
    from rodloop_cli.case.wording import one_line

    return OutputError(f"{one_line(error.filename)}: {error.strerror.lower()}")


def _unexpected(error: Exception, settings: Settings) -> int:
    if settings.debug:
        traceback.print_exception(error)
    words = " ".join(f"{type(error).__name__}: {error}".split())
    hint = "" if settings.debug else "; rerun with --debug for the traceback"
    click.echo(f"internal error: {words}{hint}", err=True)
    return RodloopError.exit_code
