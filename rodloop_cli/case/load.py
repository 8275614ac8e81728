"""From a file, or from text, to a checked case."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike, fspath
from pathlib import Path

from rodloop_cli.case.model import Case
from rodloop_cli.case.override import with_overrides
from rodloop_cli.case.report import validated
from rodloop_cli.case.rules import conflicts
from rodloop_cli.case.text import SIZE_LIMIT, Document, read_document
from rodloop_cli.case.wording import one_line
from rodloop_cli.errors import CaseError


def load_case(path: str | PathLike[str], overrides: Iterable[str] = ()) -> Case:
    """Read a case file; ``overrides`` are ``key=value`` texts, dotted for inner keys, with a YAML value.

    Raises CaseError with every problem of the file and the overrides, one line each.
    """
    return case_from(open_document(path), overrides)


def parse_case(text: str | bytes, name: str = "case", overrides: Iterable[str] = ()) -> Case:
    """Like `load_case`, for text; ``name`` stands for the file in messages."""
    return case_from(read_document(text, name), overrides)


def case_from(document: Document, overrides: Iterable[str] = ()) -> Case:
    """Check a document that was read already, for instance the base of a sweep with its axes' values set."""
    return validated(Case, with_overrides(document, overrides), conflicts)


def open_document(path: str | PathLike[str]) -> Document:
    """Read a YAML file. Raises CaseError, with one line, if it cannot be read, is too large or not YAML."""
    name = fspath(path)
    try:
        with Path(path).open("rb") as file:
            # One byte more than allowed tells a file that is too large, even an endless one.
            return read_document(file.read(SIZE_LIMIT + 1), name)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise CaseError([f"{one_line(name)}: cannot be read: {reason}"]) from None
    except ValueError:  # a NUL in the name
        raise CaseError([f"{one_line(name)}: cannot be read: not a file name"]) from None
