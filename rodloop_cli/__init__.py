"""Dynamics of a closed elastic rod in a soap film.

``Case``, ``load_case``, ``simulate`` and ``open_run`` are the Python API. Each is imported when first used:
``import rodloop_cli``, and with it ``rodloop --help``, costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rodloop_cli.case import Case as Case
    from rodloop_cli.case import load_case as load_case
    from rodloop_cli.dataset import open_run as open_run
    from rodloop_cli.simulation import simulate as simulate

__version__ = "0.1.0"
__all__ = ["Case", "__version__", "load_case", "open_run", "simulate"]

_HOMES = {"Case": "case", "load_case": "case", "open_run": "dataset", "simulate": "simulation"}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
