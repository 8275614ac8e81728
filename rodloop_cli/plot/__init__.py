"""Figures and movies of result files.

Each ``draw_*(ax, dataset, ...)`` fills one matplotlib Axes from a Dataset of `open_run` or `simulate`, so that they
compose::

    with style():
        figure = Figure(layout="constrained")
        draw_shapes(figure.add_subplot(), dataset)

`plot_file` is what ``rodloop plot`` does. Everything is imported when first used: matplotlib takes a second.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rodloop_cli.plot.displacement import draw_displacement as draw_displacement
    from rodloop_cli.plot.energies import draw_dissipation as draw_dissipation
    from rodloop_cli.plot.energies import draw_energies as draw_energies
    from rodloop_cli.plot.energies import draw_residual as draw_residual
    from rodloop_cli.plot.figures import overview as overview
    from rodloop_cli.plot.file import plot_file as plot_file
    from rodloop_cli.plot.kymograph import draw_kymograph as draw_kymograph
    from rodloop_cli.plot.lobes import draw_lobes as draw_lobes
    from rodloop_cli.plot.lobes import lobe_events as lobe_events
    from rodloop_cli.plot.lobes import mark_curvature as mark_curvature
    from rodloop_cli.plot.lobes import mark_lobe_events as mark_lobe_events
    from rodloop_cli.plot.look import style as style
    from rodloop_cli.plot.moving import movie as movie
    from rodloop_cli.plot.physical import millinewtons as millinewtons
    from rodloop_cli.plot.physical import milliseconds as milliseconds
    from rodloop_cli.plot.profiles import draw_curvature as draw_curvature
    from rodloop_cli.plot.profiles import draw_forces as draw_forces
    from rodloop_cli.plot.profiles import draw_profile as draw_profile
    from rodloop_cli.plot.shapes import draw_shape as draw_shape
    from rodloop_cli.plot.shapes import draw_shapes as draw_shapes
    from rodloop_cli.plot.speed import draw_speeds as draw_speeds

_HOMES = {
    "draw_curvature": "profiles",
    "draw_displacement": "displacement",
    "draw_dissipation": "energies",
    "draw_energies": "energies",
    "draw_forces": "profiles",
    "draw_kymograph": "kymograph",
    "draw_lobes": "lobes",
    "draw_profile": "profiles",
    "draw_residual": "energies",
    "draw_shape": "shapes",
    "draw_shapes": "shapes",
    "draw_speeds": "speed",
    "lobe_events": "lobes",
    "mark_curvature": "lobes",
    "mark_lobe_events": "lobes",
    "millinewtons": "physical",
    "milliseconds": "physical",
    "movie": "moving",
    "overview": "figures",
    "plot_file": "file",
    "style": "look",
}

__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
