"""Rows, tables and paragraphs of a Markdown page."""

from __future__ import annotations

from collections.abc import Iterator
from textwrap import dedent

Lines = Iterator[str]


def row(*cells: object) -> str:
    """A line of a table."""
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def table(*heads: str) -> Lines:
    """The head of a table."""
    yield from ("", row(*heads), row(*("---" for _ in heads)))


def section(title: str) -> Lines:
    """A heading."""
    yield from ("", f"## {title}")


def compared(what: str, paper: float, ours: float, why: str, digits: int = 4) -> str:
    """A row: the paper's number, ours, and the difference."""
    return row(what, f"{paper:g}", f"{ours:.{digits}g}", f"{100 * (ours / paper - 1):+.2g} %", why)


def paragraph(text: str) -> str:
    """Prose, after an empty line."""
    return "\n" + dedent(text).strip()
