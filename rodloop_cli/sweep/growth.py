"""The growth rate of the early departure from the initial shape, from a few stored times.

A loop released at rest departs along its fastest growing mode as u'' + c u' = k u + f: f from the perturbation or the
imbalance at the start, k from the instability, c from the drag. Integrated once, with D the size of the departure
and V = dD/dt,

    V = k int D dt + f t - c D,

which is linear in (k, f, c): no iteration, and no bias from the part of the motion that is not yet exponential.
The rate is the root sigma = -c/2 + sqrt(c^2/4 + k).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import sqrt

import numpy as np

from rodloop_cli.numerics.gauss import Array

LARGEST = 0.03
"""Departures (root mean square, over R) beyond this are not small: the rate falls with the amplitude squared."""

LEAST_TIMES = 6
LEAST_GROWTH = 1.0
"""Least rate times duration: in less, exp and t^2 cannot be told apart."""
LARGEST_MISFIT = 0.02
"""Of the velocity, root mean square; more means that this was no single exponential."""


@dataclass
class Departure:
    """Collects size and speed of the departure while it is small."""

    has_drag: bool
    _times: list[float] = field(default_factory=list)
    _sizes: list[float] = field(default_factory=list)
    _speeds: list[float] = field(default_factory=list)
    _is_over: bool = False

    def watch(self, time: float, displacement: Array, velocity: Array) -> None:
        """Take one stored time; ``displacement``, ``velocity`` [2, S] relative to the initial shape."""
        if self._is_over:
            return
        size = sqrt(float((displacement**2).sum(axis=0).mean()))
        self._is_over = size > LARGEST
        if not self._is_over:
            self._times.append(time)
            self._sizes.append(size)
            self._speeds.append(float((displacement * velocity).sum(axis=0).mean()) / size if size else 0.0)

    def rate(self) -> float | None:
        """The growth rate; None if there were too few times or the departure was not exponential."""
        if len(self._times) < LEAST_TIMES:
            return None
        return fitted_rate(np.array(self._times), np.array(self._sizes), np.array(self._speeds), self.has_drag)


def fitted_rate(times: Array, sizes: Array, speeds: Array, has_drag: bool) -> float | None:
    """The growth rate of sizes [n] and speeds [n] at times [n], from rest at the first; None if they do not grow."""
    elapsed = times - times[0]
    columns = [_integral(elapsed, sizes, speeds), elapsed, -sizes][: 3 if has_drag else 2]
    # A column that vanishes (no departure at all) must not divide by zero; its coefficient is zero then.
    scales = [float(np.abs(column).max()) or 1.0 for column in columns]
    matrix = np.stack([column / scale for column, scale in zip(columns, scales, strict=True)], axis=1)
    solution = np.linalg.lstsq(matrix, speeds, rcond=None)[0]
    misfit = float(np.linalg.norm(matrix @ solution - speeds))
    k = float(solution[0]) / scales[0]
    c = float(solution[2]) / scales[2] if has_drag else 0.0
    if k <= 0 or misfit > LARGEST_MISFIT * float(np.linalg.norm(speeds)):
        return None
    rate = -c / 2 + sqrt(c * c / 4 + k)
    return rate if rate * float(elapsed[-1]) >= LEAST_GROWTH else None


def _integral(times: Array, values: Array, slopes: Array) -> Array:
    """Running integral of values with known slopes: the cubic through both, of fourth order."""
    h = np.diff(times)
    pieces = h * (values[:-1] + values[1:]) / 2 + h**2 * (slopes[:-1] - slopes[1:]) / 12
    return np.concatenate([[0.0], np.cumsum(pieces)])
