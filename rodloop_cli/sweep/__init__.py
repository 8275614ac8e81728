"""A case over a grid of parameters: every member once, whatever happens in between.

`file` reads the sweep file, `plan` makes and checks its members, `conduct` has an executor run them, `worker` runs one,
`manifest` remembers what is done, `gather` writes sweep.nc, `collection` opens it. `run_sweep` composes them.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rodloop_cli.sweep.collection import Collection as Collection
    from rodloop_cli.sweep.collection import open_sweep as open_sweep
    from rodloop_cli.sweep.run import run_sweep as run_sweep

__all__ = ["Collection", "open_sweep", "run_sweep"]

_HOMES = {"Collection": "collection", "open_sweep": "collection", "run_sweep": "run"}


def __getattr__(name: str) -> Any:
    # On demand: a worker imports this package and must not load what only the other end needs.
    from importlib import import_module  # noqa: PLC0415

    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
