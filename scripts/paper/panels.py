"""Panels that several figures of the paper share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from rodloop_cli.plot import draw_dissipation, draw_energies, draw_forces, draw_shape, mark_lobe_events, milliseconds
from rodloop_cli.plot.lobes import fate_handles
from scripts.paper.results import result

SPACING = 2.45
"""Between shapes in a row, in R."""

SNAPSHOTS = 5


def new_figure(width: float, height: float) -> Figure:
    """An empty figure, in inches."""
    return Figure(figsize=(width, height), layout="constrained")


def frames_at(run: xr.Dataset, times: Sequence[float]) -> list[int]:
    """The stored frames nearest to some times."""
    return [int(np.abs(run["t"].to_numpy() - time).argmin()) for time in times]


def evenly(run: xr.Dataset, count: int = SNAPSHOTS) -> list[int]:
    """Frames at even intervals of time, first and last included."""
    return frames_at(run, np.linspace(0, float(run["t"][-1]), count).tolist())


def letter(ax: Axes, name: str, words: str = "") -> None:
    """The letter of a panel and what it shows."""
    ax.set_title(rf"$\bf{{{name}}}$  {words}" if words else rf"$\bf{{{name}}}$")


def draw_row(ax: Axes, run: xr.Dataset, frames: Sequence[int], *, marks: bool = False) -> None:
    """Successive shapes side by side with their times; with marks where lobes were lost since the shape before."""
    since = 0.0
    for place, frame in enumerate(frames):
        draw_shape(ax, run, frame, shift=SPACING * place, lw=1.6)
        time = float(run["t"][frame])
        if marks:
            mark_lobe_events(ax, run, frame, since=since, shift=SPACING * place)
        ax.text(SPACING * place, -1.75, f"${time:.4g}$", ha="center", va="top", size=8)
        since = time
    ax.set(xlim=(-1.35, SPACING * (len(frames) - 1) + 1.35), ylim=(-2.1, 1.7), aspect="equal")
    ax.set_axis_off()


def draw_buckling(figure: Figure | SubFigure, names: Sequence[str], letters: str) -> None:
    """A column a run: shapes on top, axial and shear force in the last frame below."""
    axes: Any = figure.subplots(3, len(names), squeeze=False, height_ratios=[1.0, 1.25, 1.25])
    for column, (name, panel) in enumerate(zip(names, letters, strict=True)):
        run = result(name)
        draw_row(axes[0, column], run, evenly(run), marks=True)
        letter(axes[0, column], panel, title_of(run))
        draw_forces(axes[1, column], run, "axial")
        draw_forces(axes[2, column], run, "shear")
        axes[1, column].set_xlabel("")
    for ax in axes[1:, 1:].flat:
        ax.set_ylabel("")
    name_fates(figure)


def name_fates(figure: Figure | SubFigure) -> None:
    """A legend below the panels for the marks of `draw_row`."""
    figure.legend(handles=list(fate_handles().values()), loc="outside lower center", ncols=2, frameon=False)


def title_of(run: xr.Dataset) -> str:
    """What a run is about, without the number of the figure."""
    return str(run.attrs["title"]).split(" (")[0]


def draw_energy_panels(figure: Figure, names: Sequence[str], letters: str) -> None:
    """A column a run: energies over the dissipation rate."""
    axes: Any = figure.subplots(2, len(names), squeeze=False, sharex="col")
    for column, (name, panel) in enumerate(zip(names, letters, strict=True)):
        run = result(name)
        draw_energies(axes[0, column], run)
        draw_dissipation(axes[1, column], run)
        axes[0, column].set_xlabel("")
        axes[0, column].set_title(rf"$\bf{{{panel}}}$  {title_of(run)}", pad=18)


def draw_midpoint(ax: Axes, runs: Sequence[xr.Dataset], labels: Sequence[str]) -> None:
    """The distance of the middle of segment 1, s = L/4, from the line through its ends, both junctions."""
    for run, label, colour in zip(runs, labels, ("#e8820c", "#1a1a1a", "#009988"), strict=True):
        ax.plot(run["t"], midpoint(run), color=colour, label=label)
    ax.set(xlabel=r"time $\,t\,\sqrt{B_1/(\rho_1 A)}\,/R^2$", ylabel="displacement at $s = L/4$, over $R$")
    ax.legend(ncols=3)
    milliseconds(ax, runs[0])


def midpoint(run: xr.Dataset) -> np.ndarray[Any, np.dtype[np.float64]]:
    """(t,): position of s = L/4 across the line through s = 0 and s = L/2, measured along x."""
    points = run.sizes["s"]
    x = run["x"].to_numpy()
    return np.asarray(x[:, points // 4] - (x[:, 0] + x[:, points // 2]) / 2)
