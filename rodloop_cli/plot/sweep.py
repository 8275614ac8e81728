"""Drawings of sweep.nc: lines over one axis, maps over two, shapes of the members where they are.

The two axes with the most points are drawn; an axis beyond them stands at its first value, which the figure says.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from rodloop_cli.case.wording import one_line
from rodloop_cli.dataset import open_run
from rodloop_cli.errors import OutputError
from rodloop_cli.plot.data import closed_profile, place
from rodloop_cli.plot.look import figure_of
from rodloop_cli.plot.options import Options
from rodloop_cli.plot.segments import pieces
from rodloop_cli.plot.sweep_axes import cells, hatch, label_of, name_ticks, points_of, tick_of, ticked

LINES = ("first_crossing_time", "first_area_minimum_time", "growth_rate", "minimum_area", "peak_kinetic_energy")
MAPS = ("first_crossing_time", "minimum_area", "growth_rate")
MOST_LINES = 8
MOST_SHAPES = 9
"""Along one axis."""

CROSSED, FAILED, NOT_RUN = 2, 4, 0
"""Codes of `status`."""

_SHAPE_SIZE = 0.36
"""Of a loop's radius, in cells."""


def open_summary(path: Path) -> xr.Dataset:
    """sweep.nc, read whole. Raises OutputError if it cannot be, or lacks what drawings need."""
    try:
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            read = dataset.load()
    except (OSError, RuntimeError, ValueError) as error:
        raise OutputError(f"{path} is damaged and cannot be read ({error}); run the sweep again") from error
    if not {"status", "member", "lobes_final", *LINES} <= set(read.data_vars) or not read["status"].size:
        raise OutputError(f"{path} is not a result of this version's rodloop sweep")
    return read


# -- figures


def overview(dataset: xr.Dataset, options: Options) -> Figure:
    """Lines over one axis; over two, the phase diagram of lobes and the map of what was found."""
    return maps(dataset, options) if len(_drawn(dataset).dims) == 2 else lines(dataset, options)


def lines(dataset: xr.Dataset, options: Options) -> Figure:
    """What was found over the longest axis, a line for each value of the other."""
    shown = _drawn(dataset)
    names = [*_found(shown, LINES), "lobes_final"]
    figure = Figure(figsize=options.size or (4.2 * min(len(names), 3), 3.1 * -(-len(names) // 3)), layout="constrained")
    grid = figure.subplots(-(-len(names) // 3), min(len(names), 3), squeeze=False).ravel()
    for ax in grid[len(names) :]:
        ax.set_axis_off()
    for ax, name in zip(grid, names, strict=False):
        draw_lines(ax, shown, name, with_legend=ax is grid[0])
    return _headed(figure, dataset)


def maps(dataset: xr.Dataset, options: Options) -> Figure:
    """The phase diagram of lobes, and a map of the first scalar that was found."""
    shown = _two(dataset)
    found = _found(shown, MAPS)[:1]
    figure = Figure(figsize=options.size or (5.6 * (1 + len(found)), 4.4), layout="constrained")
    first, *others = figure.subplots(1, 1 + len(found), squeeze=False)[0]
    draw_phases(first, shown)
    for ax, name in zip(others, found, strict=True):
        draw_map(ax, shown, name)
    return _headed(figure, dataset)


def phases(dataset: xr.Dataset, options: Options) -> Figure:
    """The phase diagram of lobes alone."""
    figure = Figure(figsize=options.size or (6.4, 4.8), layout="constrained")
    draw_phases(figure.subplots(), _two(dataset))
    return _headed(figure, dataset)


def shapes(dataset: xr.Dataset, options: Options) -> Figure:
    """The final shapes, each at its place on the axes."""
    shown = _drawn(dataset)
    columns, rows = (min(n, MOST_SHAPES) for n in (*reversed(shown["status"].shape), 1)[:2])
    figure = Figure(figsize=options.size or (1.5 + 1.15 * columns, 1.5 + 1.15 * rows), layout="constrained")
    draw_final_shapes(figure.subplots(), shown, _folder(dataset))
    return _headed(figure, dataset)


# -- drawings on one Axes


def draw_lines(ax: Axes, dataset: xr.Dataset, name: str, *, with_legend: bool = True) -> None:
    """A scalar over the last axis of a dataset of one or two axes; gaps where a member has no such value."""
    across = str(dataset["status"].dims[-1])
    x = ticked(ax, dataset, across, "x")
    rows = np.atleast_2d(dataset[name].to_numpy())
    chosen = _thinned(len(rows), MOST_LINES)
    colours = mpl.colormaps["viridis"](np.linspace(0, 0.85, len(chosen)))
    for row, colour in zip(chosen, colours, strict=True):
        label = None if len(rows) == 1 else tick_of(points_of(dataset, str(dataset["status"].dims[0]))[row])
        ax.plot(x, rows[row], "o-", color=colour, ms=3, label=label)
    ax.set_title(label_of(name))
    if name.startswith("lobes"):
        ax.yaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    if len(rows) > 1 and with_legend:
        ax.legend(title=label_of(str(dataset["status"].dims[0])))


def draw_map(ax: Axes, dataset: xr.Dataset, name: str) -> None:
    """A scalar over the two axes of a dataset, in colours; hatched where there is none."""
    values = np.ma.masked_invalid(dataset[name].to_numpy())
    edges = cells(ax, dataset)
    drawn = ax.pcolormesh(*edges, values, cmap="viridis", rasterized=True)
    hatch(ax, edges, np.ma.getmaskarray(values))
    figure_of(ax).colorbar(drawn, ax=ax)
    ax.set_title(label_of(name) + ("; hatched: none" if np.ma.is_masked(values) else ""))


def draw_phases(ax: Axes, dataset: xr.Dataset) -> None:
    """Lobes of the final shapes over the two axes; hatched: no crossing; white: failed."""
    status = dataset["status"].to_numpy()
    lobes = np.ma.masked_invalid(np.where((status == FAILED) | (status == NOT_RUN), np.nan, dataset["lobes_final"]))
    edges = cells(ax, dataset)
    counts = np.unique(lobes.compressed()).astype(int).tolist() or [0]
    levels = np.arange(min(counts), max(counts) + 2) - 0.5
    colours = ListedColormap(mpl.colormaps["viridis"](np.linspace(0.05, 0.95, len(levels) - 1)))
    drawn = ax.pcolormesh(*edges, lobes, cmap=colours, norm=BoundaryNorm(levels, colours.N), rasterized=True)
    not_crossed = (status != CROSSED) & ~np.ma.getmaskarray(lobes)
    some_crossed = bool((status == CROSSED).any())
    if some_crossed:
        hatch(ax, edges, not_crossed)
    named = [Patch(facecolor=tuple(drawn.cmap(drawn.norm(count))), label=str(count)) for count in counts]
    ax.legend(handles=named, title="lobes", loc="upper left", bbox_to_anchor=(1, 1), borderaxespad=0.3)
    when = "the first crossing" if some_crossed else "the end"
    ax.set_title(f"lobes at {when}" + ("; hatched: no crossing" if some_crossed and not_crossed.any() else ""))


def draw_final_shapes(ax: Axes, dataset: xr.Dataset, folder: Path) -> None:
    """The last stored shape of members, each at its place; a dot where there is none."""
    members = np.atleast_2d(dataset["member"].to_numpy())
    rows, columns = _thinned(members.shape[0], MOST_SHAPES), _thinned(members.shape[1], MOST_SHAPES)
    for y, row in enumerate(rows):
        for x, column in enumerate(columns):
            _draw_shape_at(ax, folder / f"{members[row, column]}.nc", x, y)
    ax.set(aspect="equal", xlim=(-0.6, len(columns) - 0.4), ylim=(-0.6, len(rows) - 0.4))
    ax.grid(visible=False)
    dims = [str(dim) for dim in dataset["status"].dims]
    name_ticks(ax, "x", dataset, dims[-1], columns)
    if len(dims) == 2:
        name_ticks(ax, "y", dataset, dims[0], rows)
    else:
        ax.set_yticks([])
    ax.set_title("final shapes")


def _draw_shape_at(ax: Axes, path: Path, x: float, y: float) -> None:
    try:
        run = open_run(path)
    except OutputError:  # failed, or kept as scalars alone
        ax.plot([x], [y], ".", color="#bbbbbb", ms=3)
        return
    with run:
        shape = [_SHAPE_SIZE * closed_profile(run, name, -1) for name in ("x", "y")]
        centre = [(part.min() + part.max()) / 2 for part in shape]
        for segment, points in pieces(run):
            part = slice(points.start, points.stop + 1)
            ax.plot(x + shape[0][part] - centre[0], y + shape[1][part] - centre[1], color=segment.colour, lw=1.2)


# -- what is drawn


def _drawn(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset over its two longest axes, the longer one last; axes of one point do not count."""
    sizes = {str(dim): n for dim, n in dataset["status"].sizes.items()}
    kept = sorted((dim for dim in sizes if sizes[dim] > 1), key=lambda dim: sizes[dim])[-2:] or list(sizes)[:1]
    return dataset.isel(dict.fromkeys(sizes.keys() - set(kept), 0)).transpose(*kept)


def _two(dataset: xr.Dataset) -> xr.Dataset:
    shown = _drawn(dataset)
    if len(shown["status"].dims) < 2:
        raise OutputError(f"{place(dataset)}a map needs two axes with several points; try --kind lines")
    return shown


def _found(dataset: xr.Dataset, names: tuple[str, ...]) -> list[str]:
    """Those that at least two members have."""
    return [name for name in names if int(dataset[name].notnull().sum()) > 1]


def _thinned(count: int, most: int) -> list[int]:
    chosen: list[int] = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int)).tolist()
    return chosen


def _folder(dataset: xr.Dataset) -> Path:
    return Path(str(dataset.encoding.get("source", "."))).parent


def _headed(figure: Figure, dataset: xr.Dataset) -> Figure:
    """Title, and what the figure does not show: other axes, members without a result."""
    figure.suptitle(one_line(str(dataset.attrs.get("title", "Parameter sweep"))), parse_math=False)
    left_out = set(dataset["status"].dims) - set(_drawn(dataset)["status"].dims)
    notes = [f"{dim} = {tick_of(points_of(dataset, str(dim))[0])}" for dim in dataset["status"].dims if dim in left_out]
    status = dataset["status"].to_numpy()
    notes += [
        f"{int((status == code).sum())} {word}"
        for code, word in ((FAILED, "failed"), (NOT_RUN, "not run"))
        if (status == code).any()
    ]
    if notes:
        figure.supxlabel("     ".join(notes), color="#555555", parse_math=False)
    return figure
