"""What several drawings share: symbols with their units, ticks, marks of junctions and of frames past a crossing."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import matplotlib.colorbar
import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from matplotlib.typing import ColorType

from rodloop_cli.plot.data import LENGTH, Array, times
from rodloop_cli.plot.frames import crossing_time, sound
from rodloop_cli.plot.look import AFTER_CROSSING, DASHES, JUNCTION, NOT_PHYSICAL
from rodloop_cli.plot.segments import materials, segments

TIME = r"time $\,t\,\sqrt{B_1/(\rho_1 A)}\,/R^2$"
ARCLENGTH = r"arclength $\,s/R$"
PROFILES = {
    "axial_force": (r"axial force", r"$F_t R^2/B_1$"),
    "shear_force": (r"shear force", r"$F_n R^2/B_1$"),
    "curvature": ("curvature", r"$\kappa R$"),
    "moment": ("bending moment", r"$M R/B_1$"),
    "theta": ("tangent angle", r"$\theta$ (rad)"),
    "x": ("horizontal position", "$x/R$"),
    "y": ("vertical position", "$y/R$"),
    "velocity_x": ("horizontal velocity", r"$v_x\,R\sqrt{\rho_1 A/B_1}$"),
    "velocity_y": ("vertical velocity", r"$v_y\,R\sqrt{\rho_1 A/B_1}$"),
}
"""Name and symbol over its unit."""

ABOVE: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0, 1), "borderaxespad": 0.1, "borderpad": 0.2}
"""Where a legend hides no data."""

VEIL = "#f3f3f3"
MOST_TICKS = 16

QUARTERS = ("0", "π/2", "π", "3π/2", "2π")


def time_axis(ax: Axes, dataset: xr.Dataset, *, says_why: bool = True) -> None:
    """Label the x axis as time, from the first stored to the last, and mark what is not physics.

    ``says_why``: not where the axes are low and those above say it.
    """
    t = times(dataset)
    if t[-1] > t[0]:
        ax.set_xlim(t[0], t[-1])
    ax.set_xlabel(TIME)
    ax.yaxis.set_offset_position("right")  # a legend or a title is on the left
    ax.xaxis.set_major_locator(MaxNLocator(6))
    limit = crossing_time(dataset)
    if limit is not None and not sound(dataset).all():
        veil(ax, max(limit, t[0]), t[-1], VEIL, says_why=says_why)


def veil(
    ax: Axes, start: float, end: float, facecolor: ColorType, zorder: float = 0.5, *, says_why: bool = True
) -> None:
    """Hatch the times after a self-crossing, and say why along the edge."""
    ax.axvspan(start, end, facecolor=facecolor, edgecolor="#bdbdbd", hatch="////", lw=0, zorder=zorder)
    ax.axvline(start, color=AFTER_CROSSING, lw=0.8, zorder=zorder)
    if not says_why:
        return
    words = ax.text(start, 0.5, f" {NOT_PHYSICAL} ", rotation=90, va="center", ha="left", size=8, color="#555555")
    words.set(transform=ax.get_xaxis_transform(), clip_on=True, in_layout=False, zorder=zorder + 2)
    words.set_bbox({"facecolor": "white", "alpha": 0.7, "lw": 0, "pad": 0.5})


def arclength_axis(ax: Axes, dataset: xr.Dataset) -> None:
    """Label the x axis as arclength in quarters of the loop, with a dotted line at every junction."""
    ax.set_xlim(0, LENGTH)
    ax.set_xticks(np.linspace(0, LENGTH, 5), QUARTERS)
    ax.set_xlabel(ARCLENGTH)
    ax.yaxis.set_offset_position("right")
    for junction in junctions(dataset):
        ax.axvline(junction, color=JUNCTION, lw=0.8, ls=":", zorder=1)


def junctions(dataset: xr.Dataset) -> list[float]:
    """Arclengths inside (0, 2 pi) where the material changes."""
    return [after.start for before, after in pairwise(segments(dataset)) if before.colour != after.colour]


def plot_in_time(
    ax: Axes, dataset: xr.Dataset, values: Array, *, color: ColorType, label: str, lw: float = 1.4
) -> None:
    """A line over time, dashed and faded from the first self-crossing on."""
    t, kept = times(dataset), sound(dataset)
    end = int(kept.sum())
    ax.plot(t[:end], values[:end], color=color, label=label, lw=lw, marker="o" if end == 1 else "", ms=4)
    if end < len(t):
        rest = slice(max(end - 1, 0), None)
        ax.plot(t[rest], values[rest], color=color, ls=DASHES, lw=1.1, alpha=0.45)


def after_crossing_line() -> Line2D:
    """The legend's note for grey, dashed curves."""
    return Line2D([], [], color=AFTER_CROSSING, ls=DASHES, lw=1.1, label=NOT_PHYSICAL)


def legend_above(ax: Axes, handles: Sequence[Artist] | None = None, columns: int = 4) -> None:
    """A legend over the axes, where it hides no data; none without entries."""
    entries = ax.get_legend_handles_labels()[0] if handles is None else list(handles)
    if entries:
        ax.legend(handles=entries, ncols=columns, **ABOVE)


def shades_in_order(dataset: xr.Dataset, frames: Sequence[int]) -> list[float]:
    """The place of each frame on the scale of shades: evenly from 0 for the first that is physics to 1 for the last."""
    physical = sound(dataset)
    ranks = np.cumsum([physical[frame] for frame in frames]) - 1
    return [float(rank / ranks[-1]) if ranks[-1] > 0 else 0.5 for rank in np.maximum(ranks, 0)]


def frame_bar(ax: Axes, dataset: xr.Dataset, frames: Sequence[int]) -> None:
    """The key of shades beside the axes: a row a frame, a column a material, grey what is not physics."""
    if len(frames) < 2:
        return
    kinds = [members[0] for members in materials(dataset).values()]
    rows = [
        [to_rgb(kind.shade(shade) if physical else AFTER_CROSSING) for kind in kinds]
        for shade, physical in zip(shades_in_order(dataset, frames), sound(dataset)[list(frames)], strict=True)
    ]
    bar, _ = matplotlib.colorbar.make_axes(ax, location="right", fraction=0.05, pad=0.02, shrink=0.75, aspect=22)
    bar.imshow(rows, aspect="auto", origin="lower", interpolation="nearest", extent=(0, len(kinds), 0, len(frames)))
    _tick_frames(bar, [time_text(dataset, frame) for frame in frames])


def _tick_frames(bar: Axes, labels: list[str]) -> None:
    shown = slice(None, None, -(-len(labels) // MOST_TICKS))
    bar.set_yticks((np.arange(len(labels)) + 0.5)[shown], labels[shown])
    bar.hlines(np.arange(1, len(labels)), *bar.get_xlim(), colors="white", lw=0.7)
    bar.grid(visible=False)
    bar.set_xticks([])
    bar.spines[:].set_visible(False)
    bar.tick_params(length=0)
    bar.yaxis.tick_right()
    bar.yaxis.set_label_position("right")
    bar.set_ylabel(TIME)


def time_text(dataset: xr.Dataset, frame: int) -> str:
    """The time of a frame, with as many decimals as tell the frames of the run apart."""
    t = times(dataset)
    return f"{t[frame]:.{decimals(float(t[-1] - t[0]))}f}"


def decimals(span: float, figures: int = 3) -> int:
    """Decimals that give a span of time about so many figures."""
    return int(np.clip(np.ceil(figures - 1 - np.log10(span)), 0, 12)) if span > 0 else figures
