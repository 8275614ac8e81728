"""Profiles along the arclength: forces, curvature, or any other variable on (t, s)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import xarray as xr
from matplotlib.axes import Axes

from rodloop_cli.plot.axes import (
    PROFILES,
    after_crossing_line,
    arclength_axis,
    frame_bar,
    legend_above,
    shades_in_order,
)
from rodloop_cli.plot.data import closed_arclength, closed_profile
from rodloop_cli.plot.frames import last_sound, sound
from rodloop_cli.plot.look import AFTER_CROSSING, DASHES
from rodloop_cli.plot.physical import millinewtons
from rodloop_cli.plot.segments import pieces
from rodloop_cli.plot.shapes import time_label

_JUMPS = {"curvature"}
"""Not joined across a junction."""


def draw_forces(
    ax: Axes, dataset: xr.Dataset, component: Literal["axial", "shear"], frames: Sequence[int] | None = None
) -> None:
    """Axial force (tension positive) or shear force (along the inward normal); default: the last physical frame."""
    draw_profile(ax, dataset, f"{component}_force", frames)
    millinewtons(ax, dataset)
    ax.axhline(0, color="#777777", lw=0.7, zorder=1)


def draw_curvature(ax: Axes, dataset: xr.Dataset, frames: Sequence[int] | None = None) -> None:
    """Curvature, negative where the loop is concave; default: the last physical frame."""
    draw_profile(ax, dataset, "curvature", frames)
    ax.axhline(0, color="#777777", lw=0.7, zorder=1)


def draw_profile(ax: Axes, dataset: xr.Dataset, name: str, frames: Sequence[int] | None = None) -> None:
    """A periodic variable on (t, s) along s, each segment in its colour, from light (early) to dark (late)."""
    chosen = list(frames) if frames is not None else [last_sound(dataset)]
    for frame, shade in zip(chosen, shades_in_order(dataset, chosen), strict=True):
        _draw_frame(ax, dataset, name, frame, shade=shade)
    arclength_axis(ax, dataset)
    words, symbol = PROFILES[name]
    ax.set_ylabel(f"{words} {symbol}")
    _tell_frames(ax, dataset, chosen)


def _draw_frame(ax: Axes, dataset: xr.Dataset, name: str, frame: int, *, shade: float) -> None:
    s, profile = closed_arclength(dataset), closed_profile(dataset, name, frame)
    physical = bool(sound(dataset)[frame])
    around = list(pieces(dataset))
    for (segment, points), (following, _) in zip(around, [*around[1:], around[0]], strict=True):
        joined = name not in _JUMPS or segment.colour == following.colour
        part = slice(points.start, points.stop + joined)
        color, ls, lw = (segment.shade(shade), "-", 1.8 - 0.8 * shade) if physical else (AFTER_CROSSING, DASHES, 1.05)
        ax.plot(s[part], profile[part], color=color, ls=ls, lw=lw)


def _tell_frames(ax: Axes, dataset: xr.Dataset, frames: list[int]) -> None:
    if len(frames) == 1:
        ax.set_title(f"at {time_label(dataset, frames[0])}")
    else:
        frame_bar(ax, dataset, frames)
        legend_above(ax, [] if sound(dataset)[frames].all() else [after_crossing_line()])
