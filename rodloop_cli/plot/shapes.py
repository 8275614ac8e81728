"""Shapes of the loop: one, many over each other, or many in a row."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from rodloop_cli.plot.axes import after_crossing_line, frame_bar, legend_above, shades_in_order, time_text
from rodloop_cli.plot.data import Array, closed_profile, values
from rodloop_cli.plot.frames import sound, spread
from rodloop_cli.plot.look import AFTER_CROSSING, DASHES, INK
from rodloop_cli.plot.segments import materials, name, pieces

MOST_NAMED = 6
"""Materials in a legend."""

SHAPES_SHOWN = 9
"""Odd, so that one of them is at the turning point of a swing."""

MARGIN = 0.06
"""Room around the shapes, of their size."""


def draw_shapes(
    ax: Axes,
    dataset: xr.Dataset,
    frames: Sequence[int] | None = None,
    *,
    spacing: float = 0.0,
    count: int = SHAPES_SHOWN,
) -> None:
    """Shapes from light (early) to dark (late), each segment in its colour, a dot at s = 0; equal aspect.

    `frames`: indices along t, else about `count` at even distances of the motion. `spacing` > 0, in R, sets each shape
    that far to the right of the one before. Frames after a self-crossing are grey and dashed, and the legend says so.
    """
    chosen = list(frames) if frames is not None else spread(dataset, count)
    for place, (frame, shade) in enumerate(zip(chosen, shades_in_order(dataset, chosen), strict=True)):
        # Late shapes are thinner, so that they do not hide the early ones when the motion returns.
        draw_shape(ax, dataset, frame, shade=shade, shift=spacing * place, lw=2.0 - shade)
    frame_axes(ax)
    frame_bar(ax, dataset, chosen)
    segment_legend(ax, dataset, chosen)


def draw_shape(
    ax: Axes, dataset: xr.Dataset, frame: int, *, shade: float = 0.5, shift: float = 0.0, lw: float = 1.4
) -> None:
    """One shape; `shade` from 0 (light) over 0.5 (the segments' own colours) to 1 (dark)."""
    x, y = closed_profile(dataset, "x", frame) + shift, closed_profile(dataset, "y", frame)
    physical = bool(sound(dataset)[frame])
    for segment, points in pieces(dataset):
        joined = slice(points.start, points.stop + 1)
        if physical:
            ax.plot(x[joined], y[joined], color=segment.shade(shade), lw=lw, zorder=2 + shade)
        else:
            ax.plot(x[joined], y[joined], color=AFTER_CROSSING, ls=DASHES, lw=1.0, zorder=1.9)
    ax.plot(x[:1], y[:1], "o", color=INK if physical else AFTER_CROSSING, ms=1.6 + 1.2 * lw, zorder=4)


def frame_axes(ax: Axes) -> None:
    """Equal aspect and the labels of positions."""
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(MARGIN)
    ax.set(xlabel="$x/R$", ylabel="$y/R$")


def common_limits(dataset: xr.Dataset, frames: Sequence[int]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits of x and y that hold all of some frames, with a margin."""
    x, y = values(dataset, "x", list(frames)), values(dataset, "y", list(frames))
    room = MARGIN * max(float(np.ptp(x)), float(np.ptp(y)), 1e-9)
    return _padded(x, room), _padded(y, room)


def _padded(positions: Array, room: float) -> tuple[float, float]:
    return float(positions.min()) - room, float(positions.max()) + room


def segment_handles(dataset: xr.Dataset, frames: Sequence[int]) -> list[Line2D]:
    """What a legend of shapes says: materials, the dot, frames that are not physics."""
    groups = list(materials(dataset).values())
    one = len(groups) == 1 == len(groups[0])
    shown = [Line2D([], [], color=m[0].colour, label="rod" if one else name(m)) for m in groups[:MOST_NAMED]]
    dot = Line2D([], [], color=INK, marker="o", ls="", ms=4, label="$s = 0$")
    crossed = not sound(dataset)[list(frames)].all()
    return [*shown, dot, *([after_crossing_line()] if crossed else [])]


def segment_legend(ax: Axes, dataset: xr.Dataset, frames: Sequence[int]) -> None:
    """The legend over the axes."""
    legend_above(ax, segment_handles(dataset, frames), columns=2)


def time_label(dataset: xr.Dataset, frame: int, separator: str = ": ") -> str:
    """``t = 0.55``, with a note if the frame is not physics."""
    note = "" if sound(dataset)[frame] else f"{separator}not physical"
    return f"$t = {time_text(dataset, frame)}${note}"
