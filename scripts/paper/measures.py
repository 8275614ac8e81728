"""Numbers read off results, for the table of reproduction."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from scripts.paper.results import ONE_THREAD

Array = npt.NDArray[np.float64]
LENGTH = 2 * np.pi


def half_width(run: xr.Dataset) -> Array:
    """(t,): half the distance of s = L/4 and s = 3L/4, along x."""
    x, points = run["x"].to_numpy(), run.sizes["s"]
    return np.asarray(x[:, points // 4] - x[:, 3 * points // 4]) / 2


def first_time(run: xr.Dataset, reached: npt.NDArray[np.bool_]) -> float:
    """The first stored time at which something holds, nan if it never does."""
    found = np.flatnonzero(reached)
    return float(run["t"][found[0]]) if len(found) else float("nan")


def radial_range(run: xr.Dataset) -> Array:
    """(t,): largest minus smallest distance from the mean position."""
    x, y = run["x"].to_numpy(), run["y"].to_numpy()
    distance = np.hypot(x - x.mean(axis=1, keepdims=True), y - y.mean(axis=1, keepdims=True))
    return np.asarray(np.ptp(distance, axis=1))


def lobes_when_visible(run: xr.Dataset, visible: float = 0.05) -> int:
    """The number of lobes when the shape first strays that much from a circle."""
    return int(run["lobes"][np.argmax(radial_range(run) > visible)])


def lobes_at(run: xr.Dataset, time: float) -> int:
    """The number of lobes at the stored time nearest to one."""
    return int(run["lobes"][np.abs(run["t"].to_numpy() - time).argmin()])


def crossing(run: xr.Dataset) -> float:
    """The time of the first self-crossing, nan if there is none."""
    return float(run.attrs.get("first_crossing_time", np.nan))


def turning_points(time: Array, values: Array) -> list[float]:
    """Times of the extrema of a curve, by a parabola through three stored points."""
    found = []
    for i in range(1, len(values) - 1):
        before, after = values[i] - values[i - 1], values[i + 1] - values[i]
        if before * after < 0:
            found.append(float(time[i] + (time[1] - time[0]) * (before + after) / 2 / (before - after)))
    return found


def largest_distance(run: xr.Dataset, other: xr.Dataset) -> float:
    """The largest distance of corresponding points at equal stored times."""
    rows = min(run.sizes["t"], other.sizes["t"])
    apart = [run[name].to_numpy()[:rows] - other[name].to_numpy()[:rows] for name in ("x", "y")]
    return float(np.hypot(*apart).max())


def critical(*options: str) -> dict[str, Any]:
    """What ``rodloop critical --json`` says of one loop."""
    command = [sys.executable, "-m", "rodloop_cli", "critical", "--p-max", "0.01", "--json", "-q", *options]
    found = subprocess.run(command, check=True, capture_output=True, env=ONE_THREAD).stdout
    return dict(json.loads(found))
