"""Lobes over time, and marks where they were lost."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from rodloop_cli.dataset.variables import LOBE_EVENT_ARCLENGTHS, LOBE_EVENT_FATES, LOBE_EVENT_TIMES
from rodloop_cli.plot.axes import legend_above, plot_in_time, time_axis
from rodloop_cli.plot.data import closed_arclength, closed_profile, times, values
from rodloop_cli.plot.look import INK

MARKS = {"coalescence": ("^", "#6b3fa0"), "collapse": ("v", "#b3261e")}
"""Marker and colour of each fate; no colour that a segment may have."""


class Event(NamedTuple):
    """A lobe that was lost: when and where (s/R) it was last seen, and how."""

    time: float
    arclength: float
    fate: str


def lobe_events(dataset: xr.Dataset) -> list[Event]:
    """The lobes that the run saw being lost, in order; none if the file does not tell."""
    fates = str(dataset.attrs.get(LOBE_EVENT_FATES, "")).split()
    numbers = [
        np.atleast_1d(np.asarray(dataset.attrs.get(name, []), dtype=np.float64))
        for name in (LOBE_EVENT_TIMES, LOBE_EVENT_ARCLENGTHS)
    ]
    if not len(fates) == len(numbers[0]) == len(numbers[1]) or not np.isfinite(numbers).all():
        return []
    return [Event(float(t), float(s), fate) for t, s, fate in zip(*numbers, fates, strict=True) if fate in MARKS]


def draw_lobes(ax: Axes, dataset: xr.Dataset) -> None:
    """The number of lobes over time, a mark at each one that was lost."""
    counted = values(dataset, "lobes")
    plot_in_time(ax, dataset, counted, color=INK, label="lobes", lw=1.2)
    t = times(dataset)
    for event in lobe_events(dataset):
        ax.plot(event.time, counted[np.argmin(np.abs(t - event.time))], **_mark(event), zorder=4)
    time_axis(ax, dataset)
    ax.set_ylabel("lobes")
    ax.set_ylim(0, 1.15 * float(counted.max()) + 1)
    name_marks(ax, dataset)


def mark_lobe_events(ax: Axes, dataset: xr.Dataset, frame: int, *, since: float = 0.0, shift: float = 0.0) -> None:
    """On a shape drawn at `frame`, `shift` to the right: the places of lobes lost since then."""
    for event in _between(dataset, since, float(times(dataset)[frame])):
        place = _sample(dataset, event)
        x, y = closed_profile(dataset, "x", frame)[place], closed_profile(dataset, "y", frame)[place]
        ax.plot(x + shift, y, **_mark(event), zorder=5)


def mark_curvature(ax: Axes, dataset: xr.Dataset, frame: int, *, since: float = 0.0) -> None:
    """The same marks on the profile of the curvature at `frame`."""
    s, curvature = closed_arclength(dataset), closed_profile(dataset, "curvature", frame)
    for event in _between(dataset, since, float(times(dataset)[frame])):
        place = _sample(dataset, event)
        ax.plot(s[place], curvature[place], **_mark(event), zorder=5)


def name_marks(ax: Axes, dataset: xr.Dataset) -> None:
    """A legend over the axes for the fates that occur."""
    occur = {event.fate for event in lobe_events(dataset)}
    legend_above(ax, [handle for fate, handle in fate_handles().items() if fate in occur])


def fate_handles() -> dict[str, Line2D]:
    """What a legend shows for each fate."""
    return {fate: Line2D([], [], **_mark(Event(0, 0, fate)), label=f"lobe lost by {fate}") for fate in MARKS}


def _between(dataset: xr.Dataset, since: float, until: float) -> list[Event]:
    return [event for event in lobe_events(dataset) if since < event.time <= until]


def _sample(dataset: xr.Dataset, event: Event) -> int:
    return int(np.argmin(np.abs(closed_arclength(dataset)[:-1] - event.arclength)))


def _mark(event: Event) -> dict[str, Any]:
    marker, colour = MARKS[event.fate]
    return {"marker": marker, "color": colour, "ms": 7.0, "ls": "", "mec": "white"}
