"""Words for error messages: values, keys and suggestions, short and on one line whatever was written."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any

LONGEST_VALUE = 40
LONGEST_LINE = 200


def one_line(text: str, limit: int = LONGEST_LINE) -> str:
    """The text with whatever does not print escaped, cut where it gets long."""
    escaped = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text[:limit])
    return escaped if len(text) <= limit else escaped + "..."


def dotted(loc: Iterable[str | int]) -> str:
    """``perturbation.0.amplitude``, as an override writes it."""
    return ".".join(one_line(str(step), LONGEST_VALUE) for step in loc)


def abbreviated(value: Any) -> str:
    """The value as YAML would show it, or its size if it is long."""
    text = _spelled(value)
    if len(text) <= LONGEST_VALUE or isinstance(value, str):
        return text
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}"
    return "a mapping" if isinstance(value, dict) else text[:LONGEST_VALUE] + "..."


def _spelled(value: Any) -> str:
    if value is None or isinstance(value, bool):
        return {None: "nothing", True: "true", False: "false"}[value]
    if isinstance(value, str):
        return f"'{one_line(value, LONGEST_VALUE)}'"
    if isinstance(value, list | tuple):
        return f"[{', '.join(abbreviated(item) for item in value[:LONGEST_VALUE])}]"
    if isinstance(value, dict):
        shown = list(value.items())[:LONGEST_VALUE]
        return "{" + ", ".join(f"{dotted([key])}: {abbreviated(item)}" for key, item in shown) + "}"
    return f"{value:.10g}" if isinstance(value, float) else str(value)


def did_you_mean(word: str, choices: Iterable[str]) -> str:
    """``; did you mean 'gamma'?`` if one of the choices is close, else nothing."""
    by_lower = {choice.lower(): choice for choice in choices}
    close = get_close_matches(word.lower()[:LONGEST_VALUE], by_lower, n=1)
    return f"; did you mean '{by_lower[close[0]]}'?" if close else ""
