"""Lobes of a closed shape, counted from its curvature.

A *lobe* is a convex protrusion: a crest of the curvature kappa(s), with kappa > 0 at its top, that stands out from
the valleys on both sides by at least `PROMINENCE` of the whole range of kappa around the loop. A circle has
none; a mode-n perturbation of it, kappa = 1 + eps (n^2 - 1) cos(n s), has n at any amplitude; so has the deep
buckled shape that grows out of it. The two ways of losing a lobe are the two clauses of the definition: in
*coalescence* the valley between two lobes rises until neither stands out from it, in *collapse* the top of the
middle one turns concave.

Crests are judged by their height above the valleys (topographic prominence) and not by their number, so that
a ripple of small amplitude on a lobe does not break it up, and a jump of the curvature at a stiffness
junction, which is one flank of a crest, adds none.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from rodloop_cli.physics.around import following

PROMINENCE = 0.05
"""Least height of a lobe over the higher of its valleys, as a fraction of the range of curvature. Ripples from the
junctions stay below it; lobes of a segment up to some 10 times stiffer than the rest, whose curvature is that
much smaller, stay above."""

TWO_PASSES = np.array([1.0, 4.0, 6.0, 4.0, 1.0]) / 16.0
"""The weights of the (1, 2, 1)/4 filter applied twice."""

LEAST_RANGE = 1e-6
"""A range of curvature (times R) below which the shape is a circle: a mode-2 perturbation of amplitude 1e-6 makes
6e-6, what Newton's tolerance leaves on a circle is smaller."""


def count_lobes(curvature: npt.NDArray[np.float64]) -> int:
    """Number of lobes; `curvature` [S] as for `find_lobes`."""
    return len(_tops(curvature))


def find_lobes(curvature: npt.NDArray[np.float64]) -> npt.NDArray[np.intp]:
    """Indices of the samples at the tops of the lobes, ascending along s.

    `curvature` [S]: kappa R at points in order around the loop, counter-clockwise, the first not repeated; evenly
    spaced or nearly so, and at least some 8 to a lobe.
    """
    return np.array(_tops(curvature), dtype=np.intp)


def _tops(curvature: npt.NDArray[np.float64]) -> list[int]:
    smooth = _without_grid_ripple(np.asarray(curvature, dtype=np.float64))
    span = float(smooth[smooth.argmax()] - smooth[smooth.argmin()])
    if span < LEAST_RANGE:
        return []
    extremes = _extremes(smooth)
    places, heights = extremes.tolist(), smooth[extremes].tolist()
    lowest = heights.index(min(heights))
    places, heights = places[lowest:] + places[:lowest], heights[lowest:] + heights[:lowest]
    return sorted(places[i] for i in _standing_out(heights, PROMINENCE * span) if heights[i] > 0.0)


def _without_grid_ripple(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Two passes of the periodic (1, 2, 1)/4 filter: removes waves of 2 or 3 samples, overshoots nowhere."""
    return np.correlate(np.concatenate([values[-2:], values, values[:2]]), TWO_PASSES, mode="valid")


def _extremes(values: npt.NDArray[np.float64]) -> npt.NDArray[np.intp]:
    """Indices of the alternating minima and maxima around the loop."""
    steps = following(values) - values
    moving = steps.nonzero()[0]  # plateaus count as one point
    rising = (steps > 0.0)[moving]
    extremes: npt.NDArray[np.intp] = following(moving)[following(rising) != rising]
    return extremes


def _standing_out(heights: Sequence[float], least: float) -> Iterator[int]:
    """Positions of the maxima with prominence >= `least`, in a closed sequence that starts at its minimum."""
    lowest, top, climbing = heights[0], 0, False
    for i, height in enumerate([*heights, heights[0]]):
        if climbing:
            if height > heights[top]:
                top = i
            elif heights[top] - height >= least:
                yield top
                lowest, climbing = height, False
        elif height - lowest >= least:
            top, climbing = i, True
        else:
            lowest = min(lowest, height)
