"""One figure for each kind: the draw functions on axes of their own, with a title."""

from __future__ import annotations

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rodloop_cli.plot.displacement import draw_displacement
from rodloop_cli.plot.energies import draw_dissipation, draw_energies, draw_residual
from rodloop_cli.plot.frames import last_sound, nearest, spread
from rodloop_cli.plot.heading import head
from rodloop_cli.plot.kymograph import draw_kymograph
from rodloop_cli.plot.options import Options
from rodloop_cli.plot.physical import milliseconds
from rodloop_cli.plot.profiles import draw_curvature, draw_forces
from rodloop_cli.plot.shapes import SHAPES_SHOWN, common_limits, draw_shape, draw_shapes, time_label

SNAPSHOTS_IN_A_ROW = 5
PROFILES_SHOWN = 4


def overview(dataset: xr.Dataset, options: Options) -> Figure:
    """Shapes, energies, swings of the midpoints, and the forces in the last frame that is physics or asked for."""
    figure = new_figure((13.0, 6.4), options)
    frames = asked(dataset, options)
    last = [frames[-1] if frames else last_sound(dataset)]
    axes = figure.subplot_mosaic("SED;SAN", width_ratios=[1.35, 1, 1])
    draw_shapes(axes["S"], dataset, frames)
    draw_energies(axes["E"], dataset)
    draw_displacement(axes["D"], dataset)
    milliseconds(axes["E"], dataset)
    milliseconds(axes["D"], dataset)
    draw_forces(axes["A"], dataset, "axial", last)
    draw_forces(axes["N"], dataset, "shear", last)
    head(figure, dataset)
    return figure


def shapes(dataset: xr.Dataset, options: Options) -> Figure:
    """Shapes over each other, and the same ones one by one."""
    frames = asked(dataset, options) or spread(dataset, SHAPES_SHOWN)
    figure = new_figure((13.0, 6.0), options)
    left, right = figure.subfigures(1, 2, squeeze=False, width_ratios=[1, 1.35])[0].tolist()
    draw_shapes(left.subplots(), dataset, frames)
    rows = -(-len(frames) // SNAPSHOTS_IN_A_ROW)
    grid = right.subplots(rows, min(len(frames), SNAPSHOTS_IN_A_ROW), squeeze=False).ravel().tolist()
    _draw_snapshots(grid, dataset, frames)
    head(figure, dataset)
    return figure


def energies(dataset: xr.Dataset, options: Options) -> Figure:
    """Energy changes, and the residual of their balance on a scale of its own."""
    figure = new_figure((7.5, 6.0), options)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[2.6, 1])
    draw_energies(upper, dataset)
    upper.set_xlabel("")
    draw_residual(lower, dataset)
    milliseconds(lower, dataset)
    head(figure, dataset)
    return figure


def forces(dataset: xr.Dataset, options: Options) -> Figure:
    """Axial and shear force at several times."""
    frames = asked(dataset, options) or _moving(dataset)
    figure = new_figure((7.5, 7.0), options)
    upper, lower = figure.subplots(2, 1, sharex=True)
    draw_forces(upper, dataset, "axial", frames)
    upper.set_xlabel("")
    draw_forces(lower, dataset, "shear", frames)
    head(figure, dataset)
    return figure


def curvature(dataset: xr.Dataset, options: Options) -> Figure:
    """Curvature at several times."""
    figure = new_figure((7.5, 4.4), options)
    draw_curvature(figure.subplots(), dataset, asked(dataset, options) or _moving(dataset))
    head(figure, dataset)
    return figure


def kymograph(dataset: xr.Dataset, options: Options) -> Figure:
    """Curvature over time and arclength."""
    figure = new_figure((8.0, 4.8), options)
    draw_kymograph(figure.subplots(), dataset)
    head(figure, dataset)
    return figure


def displacement(dataset: xr.Dataset, options: Options) -> Figure:
    """How the midpoints of the segments swing."""
    figure = new_figure((7.5, 4.4), options)
    ax = figure.subplots()
    draw_displacement(ax, dataset)
    milliseconds(ax, dataset)
    head(figure, dataset)
    return figure


def dissipation(dataset: xr.Dataset, options: Options) -> Figure:
    """The power that the film takes, over the energies."""
    figure = new_figure((7.5, 6.0), options)
    upper, lower = figure.subplots(2, 1, sharex=True)
    draw_dissipation(upper, dataset)
    upper.set_xlabel("")
    draw_energies(lower, dataset)
    milliseconds(lower, dataset)
    head(figure, dataset)
    return figure


def new_figure(size: tuple[float, float], options: Options) -> Figure:
    """An empty figure of the kind's own size unless another is asked for."""
    return Figure(figsize=options.size or size, layout="constrained")


def asked(dataset: xr.Dataset, options: Options) -> list[int] | None:
    """The stored frames nearest to the times that are asked for; None if none are."""
    return nearest(dataset, options.times) if options.times else None


def _moving(dataset: xr.Dataset) -> list[int]:
    """Frames along the motion, without the start, where forces and curvature tell least."""
    frames = spread(dataset, PROFILES_SHOWN)
    return frames[1:] or frames


def _draw_snapshots(grid: list[Axes], dataset: xr.Dataset, frames: list[int]) -> None:
    x_limits, y_limits = common_limits(dataset, frames)
    for ax in grid:
        ax.set_axis_off()
    for ax, frame in zip(grid, frames, strict=False):
        draw_shape(ax, dataset, frame)
        ax.set(xlim=x_limits, ylim=y_limits, aspect="equal")
        ax.set_title(time_label(dataset, frame, "\n"), loc="center")
