"""Which figures and movies there are, what each needs, and drawing one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from matplotlib.figure import Figure

from rodloop_cli.plot import plot_file, style
from scripts.paper import appendix, density, homogeneous, stiffness
from scripts.paper.results import CONFIGS, OUT, result

FIGURES: dict[str, Callable[[], Figure]] = {
    drawn.__name__: drawn
    for drawn in (
        *(homogeneous.fig02, homogeneous.fig03, homogeneous.fig04, homogeneous.fig05, homogeneous.fig06),
        *(homogeneous.fig07, stiffness.fig08, stiffness.fig09, stiffness.fig10, stiffness.fig11, stiffness.fig12),
        *(stiffness.fig13, stiffness.fig14, density.fig15, density.fig16, density.fig17, appendix.figC1),
    )
}
SHARED = {"fig07": ("fig06",), "fig10": ("fig09",), "fig14": ("fig12_drag2", "fig13_drag2")}
"""Figures that draw the runs of another."""

MOVIES = ("movieS1", "movieS2", "movieS3")
MOVIE_FORMAT = "html"
"""Needs nothing beside a browser; gif is larger, mp4 wants ffmpeg."""

DPI = 110


def runs_of(name: str) -> Iterator[str]:
    """The case files that a figure draws."""
    if name in SHARED:
        yield from SHARED[name]
    elif name != "fig02":  # a closed formula
        yield from (path.stem for path in CONFIGS.glob(f"{name}*.yaml"))


def draw(name: str) -> str:
    """One figure or movie; its path."""
    path = OUT / f"{name}.{MOVIE_FORMAT if name in MOVIES else 'png'}"
    if name in MOVIES:
        plot_file(Path(result(name).encoding["source"]), "movie", path)
    else:
        with style():
            FIGURES[name]().savefig(path, dpi=DPI)
    return str(path)
