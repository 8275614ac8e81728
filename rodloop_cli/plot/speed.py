"""Shapes coloured by the speed of their points, as in Fig. C.1."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from rodloop_cli.plot.data import Array, closed_profile
from rodloop_cli.plot.frames import sound, spread
from rodloop_cli.plot.look import INK
from rodloop_cli.plot.shapes import SHAPES_SHOWN, frame_axes

COLOURS = "viridis"


def draw_speeds(
    ax: Axes, dataset: xr.Dataset, frames: Sequence[int] | None = None, *, spacing: float = 2.6
) -> LineCollection:
    """Shapes in a row, `spacing` apart (in R), coloured by speed on one scale; those that are not physics left out.

    Returns the coloured lines, for a colorbar; by default about `SHAPES_SHOWN` frames at even distances of the motion.
    """
    physical = sound(dataset)
    chosen = [frame for frame in (frames if frames is not None else spread(dataset, SHAPES_SHOWN)) if physical[frame]]
    lines, speeds = [], []
    for place, frame in enumerate(chosen):
        shape = _shape(dataset, frame) + np.array([spacing * place, 0.0])
        lines.append(np.stack([shape[:-1], shape[1:]], axis=1))
        speeds.append(_speed(dataset, frame))
        ax.plot(*shape[0], "o", color=INK, ms=3, zorder=4)
    coloured = LineCollection(np.concatenate(lines).tolist(), cmap=COLOURS, array=np.concatenate(speeds), lw=2.2)
    ax.add_collection(coloured)
    ax.autoscale_view()
    frame_axes(ax)
    return coloured


def _shape(dataset: xr.Dataset, frame: int) -> Array:
    """(S + 1, 2)."""
    return np.stack([closed_profile(dataset, "x", frame), closed_profile(dataset, "y", frame)], axis=-1)


def _speed(dataset: xr.Dataset, frame: int) -> Array:
    """(S,): of the middles of the sides."""
    speed = np.hypot(closed_profile(dataset, "velocity_x", frame), closed_profile(dataset, "velocity_y", frame))
    return np.asarray((speed[:-1] + speed[1:]) / 2)
