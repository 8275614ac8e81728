"""Names of members: what was varied, and the values."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from hashlib import sha256
from typing import Any

from rodloop_cli.sweep.axes import is_number

LONGEST_NAME = 160
"""Leaves room for endings within the 255 bytes of file systems."""

_PLAIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9.+-]{0,39}")


def member_name(varied: Iterable[tuple[str, Any]]) -> str:
    """``stiffness_ratio=5_p=16``: a file name without its ending, the same for the same values in any grid."""
    name = "_".join(f"{key}={value_label(value)}" for key, value in varied)
    return name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 11]}..{_short_hash(name)}"


def value_label(value: Any) -> str:
    """A value in a name: numbers in six digits where that is exact enough, odd texts and lists by a hash."""
    if is_number(value):
        short = f"{value:.6g}"
        return short if float(short) == value else f"{value:.{_DIGITS}g}"
    if isinstance(value, str) and _PLAIN.fullmatch(value):
        return value
    return _short_hash(json.dumps(value, sort_keys=True))


_DIGITS = 14  # as many as spaced values have


def _short_hash(text: str) -> str:
    return sha256(text.encode()).hexdigest()[:8]
