"""Which stored frames to draw, and which of them are physics."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr

from rodloop_cli.plot.data import times, values

ROUND_OFF = 1e-9
"""Of the time of the first crossing: the frame stored at the touch itself still counts as physics."""

_MOST_CANDIDATES = 2000


def sound(dataset: xr.Dataset) -> npt.NDArray[np.bool_]:
    """(t,): whether a frame is physics: not after the first self-crossing, for the model has no contact."""
    t, limit = times(dataset), crossing_time(dataset)
    return t <= limit * (1 + ROUND_OFF) if limit is not None else np.ones(len(t), dtype=bool)


def crossing_time(dataset: xr.Dataset) -> float | None:
    """Time of the first self-crossing as located by the run, or else the last time before a frame shows it."""
    flagged = np.flatnonzero(values(dataset, "crossing"))
    located = _number(dataset.attrs.get("first_crossing_time"))
    if not len(flagged):
        return located
    first = int(flagged[0])
    t = times(dataset)
    if located is not None and located <= t[first] * (1 + ROUND_OFF):
        return located
    # Not located: somewhere before the first frame that shows it, and after the frame before.
    return float(t[first - 1]) if first else -math.inf


def last_sound(dataset: xr.Dataset) -> int:
    """The last frame that is physics; the first frame if none is."""
    found = np.flatnonzero(sound(dataset))
    return int(found[-1]) if len(found) else 0


def nearest(dataset: xr.Dataset, wanted: Sequence[float]) -> list[int]:
    """The stored frames nearest to some times, ascending, each once."""
    t = times(dataset)
    return sorted({int(np.argmin(np.abs(t - time))) for time in wanted})


def spread(dataset: xr.Dataset, count: int) -> list[int]:
    """About `count` physical frames at even distances of the motion, first and last included, and a few after."""
    kept = sound(dataset)
    before, after = np.flatnonzero(kept), np.flatnonzero(~kept)
    return _along_the_motion(dataset, before, count) + _along_the_motion(dataset, after, count // 3 + 1)[1:]


def _along_the_motion(dataset: xr.Dataset, among: npt.NDArray[np.intp], count: int) -> list[int]:
    """Frames at even lengths of the path (root mean square over the loop): a slow start gives few, a fast end many."""
    if len(among) <= 1:
        return [int(frame) for frame in among]
    candidates = np.unique(np.append(among[:: -(-len(among) // _MOST_CANDIDATES)], among[-1]))
    x, y = values(dataset, "x")[candidates], values(dataset, "y")[candidates]
    moved = np.sqrt((np.diff(x, axis=0) ** 2 + np.diff(y, axis=0) ** 2).mean(axis=1))
    # A little for the mere passing of time, so that a loop at rest has its frames too.
    path = np.append(0.0, np.cumsum(moved + 1e-3 * moved.mean() + 1e-12))
    wanted = np.linspace(0.0, path[-1], max(count, 2))
    chosen = {int(candidates[np.argmin(np.abs(path - length))]) for length in wanted}
    return sorted(chosen)


def _number(attribute: object) -> float | None:
    if isinstance(attribute, int | float | np.integer | np.floating) and math.isfinite(attribute):
        return float(attribute)
    return None
