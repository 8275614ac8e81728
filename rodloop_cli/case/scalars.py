"""Plain YAML scalars by the core schema of YAML 1.2: what looks like a number is one, without surprises.

PyYAML follows YAML 1.1: ``1e-8`` is text, ``yes`` is true, ``12:30:45`` is 45045, ``2024-01-01`` is a date.
"""

from __future__ import annotations

import re

Scalar = str | float | int | bool | None

#: No count or seed of a case needs more; Python itself refuses to read thousands of digits.
LONGEST_INTEGER = 30

_NAMED: dict[str, Scalar] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
}
_INTEGER = re.compile(r"[-+]?[0-9]+|0x[0-9a-fA-F]+|0o[0-7]+", re.ASCII)
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", re.ASCII)
_INFINITE = re.compile(r"[-+]?\.(inf|Inf|INF)")
_NOT_A_NUMBER = re.compile(r"\.(nan|NaN|NAN)")


def plain_value(text: str) -> Scalar:
    """The value of an unquoted scalar. Raises ValueError for an integer of more than 30 characters."""
    if text in _NAMED:
        return _NAMED[text]
    if _INTEGER.fullmatch(text):
        return _integer(text)
    if _FLOAT.fullmatch(text):
        return float(text)
    if _INFINITE.fullmatch(text) or _NOT_A_NUMBER.fullmatch(text):
        return float(text.replace(".", ""))
    return text


def _integer(text: str) -> int:
    if len(text) > LONGEST_INTEGER:
        raise ValueError(f"an integer of more than {LONGEST_INTEGER} characters")
    base = {"0x": 16, "0o": 8}.get(text[:2], 10)
    return int(text, base)
