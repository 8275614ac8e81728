"""A movie: the shape on the left, the energies with a moving marker on the right."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from rodloop_cli.plot.axes import decimals
from rodloop_cli.plot.data import thinned, times, values
from rodloop_cli.plot.energies import change, draw_energies, shown
from rodloop_cli.plot.figures import asked, new_figure
from rodloop_cli.plot.frames import sound
from rodloop_cli.plot.heading import head, title_of
from rodloop_cli.plot.look import AFTER_CROSSING, ALARM, DASHES, INK, NOT_PHYSICAL
from rodloop_cli.plot.options import Options
from rodloop_cli.plot.output import drawing
from rodloop_cli.plot.segments import pieces
from rodloop_cli.plot.shapes import common_limits, frame_axes, segment_legend

SIZE = (9.6, 4.6)
DPI = 100.0
MOST_FRAMES = 300
"""A movie of a run with more stored times takes every n-th."""


class Part(NamedTuple):
    """What moves: some artists, and how they show a frame."""

    artists: list[Artist]
    show: Callable[[int], None]


class Movie:
    """Pictures of a figure in which a few artists move; everything else is drawn once."""

    def __init__(self, figure: Figure, parts: list[Part], frames: list[int], title: str) -> None:
        self.title = title
        self._canvas = FigureCanvasAgg(figure)
        self._parts = parts
        self._frames = frames
        for part in parts:
            for artist in part.artists:
                artist.set(animated=True, in_layout=False)
        with drawing():
            self._canvas.draw()  # type: ignore[no-untyped-call]
        self._still = self._canvas.copy_from_bbox(figure.bbox)  # type: ignore[no-untyped-call]

    def __len__(self) -> int:
        return len(self._frames)

    def __iter__(self) -> Iterator[Image.Image]:
        return (self.picture(index) for index in range(len(self)))

    def picture(self, index: int) -> Image.Image:
        """One frame, RGB."""
        self._canvas.restore_region(self._still)  # type: ignore[no-untyped-call]
        for part in self._parts:
            part.show(self._frames[index])
            for artist in part.artists:
                self._canvas.figure.draw_artist(artist)
        pixels = np.asarray(self._canvas.buffer_rgba())  # type: ignore[no-untyped-call]
        return Image.fromarray(pixels).convert("RGB")


def movie(dataset: xr.Dataset, options: Options) -> Movie:
    """The moving shape, each segment in its colour, and the energies; grey and with a note what is not physics."""
    count = len(times(dataset))
    frames = asked(dataset, options) or list(range(count))[thinned(count, MOST_FRAMES)]
    figure = new_figure(SIZE, options)
    figure.set_dpi(options.dpi or DPI)
    left, right = figure.subplots(1, 2)
    left.update_datalim(np.transpose(common_limits(dataset, frames)))
    left.autoscale_view()
    frame_axes(left)
    segment_legend(left, dataset, [0])
    draw_energies(right, dataset)
    head(figure, dataset)
    parts = [_shape(left, dataset), _clock(left, dataset), _marker(right, dataset)]
    return Movie(figure, parts, frames, title_of(dataset))


def _shape(ax: Axes, dataset: xr.Dataset) -> Part:
    x, y, physical = values(dataset, "x"), values(dataset, "y"), sound(dataset)
    around = list(pieces(dataset))
    lines = [ax.plot([], [], lw=2)[0] for _ in around]
    (dot,) = ax.plot([], [], "o", ms=4)

    def show(frame: int) -> None:
        for line, (segment, points) in zip(lines, around, strict=True):
            joined = np.arange(points.start, points.stop + 1) % x.shape[1]
            line.set_data(x[frame, joined], y[frame, joined])
            line.set(color=segment.colour if physical[frame] else AFTER_CROSSING, ls="-" if physical[frame] else DASHES)
        dot.set_data(x[frame, :1], y[frame, :1])
        dot.set_color(INK if physical[frame] else AFTER_CROSSING)

    return Part([*lines, dot], show)


def _clock(ax: Axes, dataset: xr.Dataset) -> Part:
    t, physical = times(dataset), sound(dataset)
    clock = ax.text(0.02, 0.02, "", transform=ax.transAxes, va="bottom")
    warning = ax.text(0.98, 0.02, NOT_PHYSICAL, transform=ax.transAxes, ha="right", va="bottom", color=ALARM)
    digits = decimals(float(t[-1] - t[0]), figures=4)

    def show(frame: int) -> None:
        clock.set_text(f"$t = {t[frame]:.{digits}f}$")
        warning.set_visible(not physical[frame])

    return Part([clock, warning], show)


def _marker(ax: Axes, dataset: xr.Dataset) -> Part:
    t = times(dataset)
    curves = [(energy.colour, change(dataset, energy)) for energy in shown(dataset)]
    bar = ax.axvline(t[0], color=INK, lw=0.8)
    dots = [ax.plot([], [], "o", color=colour, ms=5, clip_on=False)[0] for colour, _ in curves]

    def show(frame: int) -> None:
        bar.set_xdata([t[frame], t[frame]])
        for dot, (_, curve) in zip(dots, curves, strict=True):
            dot.set_data([t[frame]], [curve[frame]])

    return Part([bar, *dots], show)
