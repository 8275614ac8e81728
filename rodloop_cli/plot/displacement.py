"""How far the middles of the segments swing."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from rodloop_cli.plot.axes import legend_above, plot_in_time, time_axis
from rodloop_cli.plot.data import LENGTH, Array, closed_arclength, values
from rodloop_cli.plot.segments import Segment, segments

MOST_LINES = 6


class Arc(NamedTuple):
    """A stretch of the loop whose middle is followed."""

    start: float
    end: float
    label: str
    colour: str
    lw: float = 1.4


def draw_displacement(ax: Axes, dataset: xr.Dataset) -> None:
    """Transverse displacement w of the middle of each segment: how far outside the line through its ends it is.

    For two equal segments that move symmetrically it is the distance from the axis through both junctions.
    A loop of one segment is followed at s = L/4 and 3L/4. Of many segments the longest are drawn.
    """
    for arc in _arcs(segments(dataset)):
        plot_in_time(ax, dataset, transverse(dataset, arc.start, arc.end), color=arc.colour, label=arc.label, lw=arc.lw)
    time_axis(ax, dataset)
    ax.set_ylabel("midpoint displacement $w/R$")
    legend_above(ax, columns=3)


def transverse(dataset: xr.Dataset, start: float, end: float) -> Array:
    """(t,): distance of the middle of an arc from its chord, positive on the chord's right, which is outward."""
    first, middle, last = (_position(dataset, s) for s in (start, (start + end) / 2, end))
    chord, reach = last - first, middle - first
    length = np.hypot(*chord)
    # Ends that meet have no chord; where they do the loop is about to cross itself.
    cross = chord[1] * reach[0] - chord[0] * reach[1]
    return np.asarray(np.divide(cross, length, out=np.full_like(length, np.nan), where=length > 1e-9))


def _position(dataset: xr.Dataset, arclength: float) -> Array:
    """(2, t): the position at an arclength, between points linear."""
    s = closed_arclength(dataset)
    right = int(np.clip(np.searchsorted(s, arclength, side="right"), 1, len(s) - 1))
    weight = (arclength - s[right - 1]) / (s[right] - s[right - 1])
    both = np.stack([values(dataset, "x"), values(dataset, "y")])
    return np.asarray((1 - weight) * both[..., right - 1] + weight * both[..., right % (len(s) - 1)])


def _arcs(all_segments: tuple[Segment, ...]) -> Iterator[Arc]:
    if len(all_segments) == 1:
        only = all_segments[0]
        # In a symmetric motion the second line lies on the first.
        yield Arc(0, LENGTH / 2, "at $s = L/4$", only.shade(0.3), lw=2.6)
        yield Arc(LENGTH / 2, LENGTH, "at $s = 3L/4$", only.shade(1.0), lw=1.0)
        return
    longest = sorted(all_segments, key=lambda segment: segment.start - segment.end)[:MOST_LINES]
    for segment in sorted(longest, key=lambda segment: segment.number):
        alike = [other for other in longest if other.colour == segment.colour]
        shade = 0.5 if len(alike) == 1 else 0.35 + 0.65 * alike.index(segment) / (len(alike) - 1)
        yield Arc(segment.start, segment.end, f"segment {segment.number}", segment.shade(shade))
