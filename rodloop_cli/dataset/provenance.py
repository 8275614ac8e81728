"""Global attributes of a result: what was computed, from what, by which versions, and how it ended."""

from __future__ import annotations

import importlib.metadata
import platform
from collections.abc import Mapping
from datetime import UTC, datetime

import numpy as np

from rodloop_cli import __version__
from rodloop_cli.dataset.variables import Attribute

CONVENTIONS = "CF-1.11"
SOURCE = "rodloop"
"""The first word of the attribute `source`; the reader knows its own files by it."""

GOOD_ENDS = ("reached t_end", "stopped at first crossing", "settled")
"""How the outcome of a run begins that did not fail."""

_PACKAGES = ("numpy", "scipy", "netCDF4")


def run_attributes(*, title: str, case_text: str, case_sha256: str, command: str) -> dict[str, Attribute]:
    """What is known before the run; `case_text` is the resolved case, `command` what the user typed."""
    return {
        "Conventions": CONVENTIONS,
        "title": title,
        "history": f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}: {command}",
        "source": f"{SOURCE} {__version__}, motion of an elastic rod loop in a soap film",
        "case": case_text,
        "case_sha256": case_sha256,
        **{f"version_{name}": version for name, version in versions().items()},
    }


def outcome_attributes(outcome: str, totals: Mapping[str, int | float]) -> dict[str, Attribute]:
    """What is known at the end: the outcome as a sentence and the solver's totals, each as `total_NAME`."""
    return {"outcome": outcome, **{f"total_{name}": value for name, value in totals.items()}}


def versions() -> dict[str, str]:
    """Version of rodloop, of Python and of the packages behind the numbers, without importing them."""
    packages = {name: importlib.metadata.version(name) for name in _PACKAGES}
    return {SOURCE: __version__, "python": platform.python_version(), **packages}


def clean_attributes(attributes: Mapping[str, Attribute]) -> dict[str, Attribute]:
    """The attributes in the types that a netCDF file gives back.

    TypeError for what CF forbids: bool, None, mappings.
    """
    return {name: _clean(name, value) for name, value in attributes.items()}


def _clean(name: str, value: Attribute) -> Attribute:
    match value:
        case str():
            return value
        case int() | np.integer() if not isinstance(value, bool):
            return np.int64(value)
        case float() | np.floating():
            return np.float64(value)
        case np.ndarray() if value.dtype.kind in "iuf" and value.ndim == 1:
            return value
    raise TypeError(f"attribute {name}: text, a number or a list of numbers is needed (got {value!r})")
