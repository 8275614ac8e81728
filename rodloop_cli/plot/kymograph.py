"""A profile over arclength and time, as a map."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.lines import Line2D

from rodloop_cli.errors import OutputError
from rodloop_cli.plot.axes import PROFILES, QUARTERS, TIME, junctions, legend_above, veil
from rodloop_cli.plot.data import LENGTH, Array, place, thinned, times, values
from rodloop_cli.plot.frames import crossing_time, sound
from rodloop_cli.plot.look import INK

CENTRES = {"curvature": 1.0}

MOST_CELLS = 1200
"""Of the map along each axis; a figure has not many more pixels."""

CLIPPED = 0.5
"""Percent of the values beyond the end of the colour scale: a spike must not flatten the rest."""


def draw_kymograph(ax: Axes, dataset: xr.Dataset, name: str = "curvature") -> QuadMesh:
    """Any variable on (t, s) over time and arclength. Raises OutputError if there is one frame only.

    White is zero, or for the curvature that of a circle: then a line surrounds what is concave.
    """
    t, s = times(dataset), values(dataset, "s")
    if len(t) < 2:
        raise OutputError(f"{place(dataset)}one stored time is no map; store more (snapshots in the case)")
    rows, columns = thinned(len(t), MOST_CELLS), thinned(len(s), MOST_CELLS)
    profile = values(dataset, name)[rows, columns]
    centre = CENTRES.get(name, 0.0)
    most = _scale(profile[sound(dataset)[rows]] - centre)
    mesh = ax.pcolormesh(_edges(t[rows]), np.append(s[columns], LENGTH), profile.T, cmap="RdBu_r", rasterized=True)
    mesh.set_clim(centre - most, centre + most)
    _label(ax, dataset)
    _colour_bar(ax, mesh, " ".join(PROFILES[name]), clipped=bool(np.abs(profile - centre).max() > most))
    if centre and profile.min() < 0 < profile.max():
        _outline_negative(ax, t[rows], s[columns], profile)
    return mesh


def _colour_bar(ax: Axes, mesh: QuadMesh, label: str, *, clipped: bool) -> None:
    figure = ax.get_figure(root=True)
    assert figure is not None
    figure.colorbar(mesh, ax=ax, label=label, extend="both" if clipped else "neither", pad=0.02, aspect=30)


def _outline_negative(ax: Axes, t: Array, s: Array, profile: Array) -> None:
    ax.contour(t, s, profile.T, levels=[0.0], colors=INK, linewidths=0.9)
    legend_above(ax, [Line2D([], [], color=INK, lw=0.9, label="concave inside")])


def _scale(profile: Array) -> float:
    return float(np.percentile(np.abs(profile), 100 - CLIPPED)) or 1.0 if profile.size else 1.0


def _edges(t: Array) -> Array:
    """(k + 1,): between the stored times, and at the first and the last."""
    return np.concatenate([t[:1], (t[1:] + t[:-1]) / 2, t[-1:]])


def _label(ax: Axes, dataset: xr.Dataset) -> None:
    ax.grid(visible=False)
    ax.set(xlabel=TIME, ylabel=r"arclength $\,s/R$", ylim=(0, LENGTH))
    ax.set_yticks(np.linspace(0, LENGTH, 5), QUARTERS)
    for junction in junctions(dataset):
        ax.axhline(junction, color="#444444", lw=0.8, ls=":")
    limit = crossing_time(dataset)
    if limit is not None and not sound(dataset).all():
        veil(ax, max(limit, times(dataset)[0]), times(dataset)[-1], (1, 1, 1, 0.65), zorder=2.5)
