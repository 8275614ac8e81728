"""The axes of a sweep as those of a drawing: positions, scales, ticks, labels, cells."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.ticker import LogLocator, NullLocator

from rodloop_cli.case.wording import one_line
from rodloop_cli.plot.data import Array

LOG_EVENNESS = 1e-6
"""Of the logarithms of ratios that count as equal."""

_NAMES = {
    "p": "load $p R^3/B_1$",
    "stiffness_ratio": "stiffness ratio $B_2/B_1$",
    "density_ratio": r"density ratio $\rho_2/\rho_1$",
    "k": "share of segment 1, $k$",
    "zeta_perp": r"drag $\zeta_\perp$",
    "gamma": r"drag anisotropy $\gamma$",
    "first_crossing_time": "time of first crossing",
    "first_area_minimum_time": "time of first area minimum",
    "growth_rate": "growth rate",
    "minimum_area": "smallest area $/R^2$",
    "peak_kinetic_energy": "peak kinetic energy $R/B_1$",
    "lobes_final": "lobes",
}


def points_of(dataset: xr.Dataset, dim: str) -> npt.NDArray[Any]:
    """Values along an axis: numbers, or the labels of texts and of keys varied together."""
    for name, coordinate in dataset.coords.items():
        if coordinate.dims == (dim,) and name in {dim, f"{dim}_label"}:
            labels: npt.NDArray[Any] = coordinate.to_numpy()
            return labels
    varied = [c.to_numpy() for c in dataset.coords.values() if c.dims == (dim,)]
    return np.array([", ".join(map(tick_of, point)) for point in zip(*varied, strict=True)])


def ticked(ax: Axes, dataset: xr.Dataset, dim: str, which: str) -> Array:
    """Positions of the points of an axis, with scale, ticks and label set."""
    points = points_of(dataset, dim)
    if points.dtype.kind not in "iuf":
        name_ticks(ax, which, dataset, dim, list(range(len(points))))
        return np.arange(len(points), dtype=np.float64)
    # Evenly spaced ratios ask for a logarithmic axis, evenly spaced values do not.
    is_log = len(points) > 2 and (points > 0).all() and float(np.ptp(np.diff(np.log(points)))) < LOG_EVENNESS
    axis = {"x": ax.xaxis, "y": ax.yaxis}[which]
    ax.set(**{f"{which}scale": "log" if is_log else "linear"})
    if is_log:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(lambda value, _: f"{value:g}")
        axis.set_minor_locator(NullLocator())
    axis.set_label_text(label_of(dim))
    return points.astype(np.float64)


def name_ticks(ax: Axes, which: str, dataset: xr.Dataset, dim: str, chosen: list[int]) -> None:
    """Ticks at 0, 1, ... with the values of some points of an axis."""
    points = points_of(dataset, dim)
    axis = {"x": ax.xaxis, "y": ax.yaxis}[which]
    axis.set_ticks(range(len(chosen)), [tick_of(points[i]) for i in chosen], parse_math=False)
    axis.set_label_text(", ".join(map(label_of, _names_along(dataset, dim))))


def _names_along(dataset: xr.Dataset, dim: str) -> list[str]:
    """The key that an axis stands for, or those that vary along it together."""
    if dim in dataset.coords or f"{dim}_label" in dataset.coords:
        return [dim]
    return [str(name) for name, coordinate in dataset.coords.items() if coordinate.dims == (dim,)]


def cells(ax: Axes, dataset: xr.Dataset) -> tuple[Array, Array]:
    """Edges of the cells of a map along x and y."""
    y, x = (str(dim) for dim in dataset["status"].dims)
    across, up = ticked(ax, dataset, x, "x"), ticked(ax, dataset, y, "y")
    ax.grid(visible=False)
    return _edges(across, ax.get_xscale()), _edges(up, ax.get_yscale())


def _edges(points: Array, scale: str) -> Array:
    """Half-way between points, in the logarithm on a logarithmic axis."""
    if scale == "log":
        edges: Array = np.exp(_edges(np.log(points), "linear"))
        return edges
    middle = (points[:-1] + points[1:]) / 2
    return np.concatenate([[2 * points[0] - middle[0]], middle, [2 * points[-1] - middle[-1]]])


def hatch(ax: Axes, edges: tuple[Array, Array], where: npt.NDArray[np.bool_]) -> None:
    """Hatch some cells of a map."""
    x, y = edges
    corners = [[(x[i], y[j]), (x[i + 1], y[j]), (x[i + 1], y[j + 1]), (x[i], y[j + 1])] for j, i in np.argwhere(where)]
    ax.add_collection(PolyCollection(corners, facecolor="none", edgecolor="none", hatch="////", linewidth=0))


def label_of(name: str) -> str:
    """What an axis or a scalar is called in a drawing."""
    return _NAMES.get(name, name.replace("_", " "))


def tick_of(value: Any) -> str:
    """A value in few letters."""
    return f"{value:.3g}" if isinstance(value, int | float | np.number) else one_line(str(value), 20)
