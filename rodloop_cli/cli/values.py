"""Options that take one number, a list of them or a range."""

from __future__ import annotations

import math

import click

MOST_VALUES = 100_000


def numbers(context: click.Context, parameter: click.Parameter, text: str | None) -> tuple[float, ...] | None:
    """``5``, ``1,2,5`` or ``0.15:6:40`` (forty values from 0.15 to 6, both included)."""
    if text is None:
        return None
    try:
        values = _spaced(text) if ":" in text else tuple(float(word) for word in text.split(","))
    except ValueError:
        values = ()
    if not values or not all(math.isfinite(value) for value in values):
        raise click.BadParameter(f"must be a number, a list A,B,C or a range A:B:N (got {text})", context, parameter)
    return values


def _spaced(text: str) -> tuple[float, ...]:
    first, last, count = text.split(":")
    a, b, n = float(first), float(last), int(count)
    if not 2 <= n <= MOST_VALUES:
        raise ValueError(text)
    # Twelve digits: 0.3, not 0.30000000000000004.
    return tuple(float(f"{a + (b - a) * i / (n - 1):.12g}") for i in range(n))
