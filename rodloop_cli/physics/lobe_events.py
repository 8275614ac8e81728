"""How lobes are lost: coalescence and collapse, Section 4.2 and Appendix C.

Lobes (`lobes.find_lobes`) are followed from one stored shape to the next. A lobe that is gone for good was lost in
one of two ways, whichever shows first at its place along the rod:

- *collapse*: the curvature there turns negative, the convex lobe has become a concave indentation;
- *coalescence*: the valley between it and a neighbour has vanished, the two have become one.

A shoulder lower than `SHOULDER` of the neighbour is neither yet: it sinks on and turns concave.

While the deformation is small, modes merely add up, and lobes come and go as their sum does; only shapes that stray
from the circle by `DEVELOPED` or more are followed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from enum import Enum

import numpy as np
import numpy.typing as npt

from rodloop_cli.physics.lobes import find_lobes

Array = npt.NDArray[np.float64]
Places = npt.NDArray[np.intp]

DEVELOPED = 0.2
"""Range of the radial displacement, over R, from which on the lobes of a shape can be seen."""

VANISHED = 0.01
"""Depth of a valley, as a share of the range of curvature, below which two lobes are one."""

TOGETHER = 2**14
"""Samples of shapes that are looked at at once."""

SHOULDER = 0.25
"""Curvature over that of the neighbour's top. Once the valley between them had vanished, this was 0.4 to 1 for
lobes that merged, 0.15 for one that then sank."""


class Fate(Enum):
    """How a lobe was lost."""

    COALESCENCE = "coalescence"
    COLLAPSE = "collapse"


@dataclass(frozen=True)
class LobeEvent:
    """The loss of one lobe: when and where it was last seen, and what became of it."""

    time: float
    arclength: float
    fate: Fate


@dataclass(frozen=True)
class _Lost:
    """A lobe that is out of sight: where it was (index of a sample), how far it reached, and its fate once that
    shows.
    """

    time: float
    place: int
    reach: float
    fate: Fate | None = None

    def judged(self, curvature: Array, tops: list[int]) -> _Lost:
        """With the fate that a later shape shows, if it is not known already."""
        return self if self.fate else replace(self, fate=_fate(curvature, self.place, tops))


@dataclass
class LobeWatch:
    """Follows the lobes through shapes in order of time; ``seen``: samples at their tops in the latest one.

    Shapes wait until there are enough TOGETHER, or somebody asks: one Fourier transform of all is quicker.
    """

    _time: float = 0.0
    _points: int = 1
    _seen: list[int] = field(default_factory=list)
    _lost: list[_Lost] = field(default_factory=list)
    _waiting: list[tuple[float, Array, Places | None]] = field(default_factory=list)

    def watch(self, time: float, curvature: Array, tops: Places | None = None) -> None:
        """Take the next shape; ``curvature`` [S] as for `find_lobes`, and what that found if it is at hand."""
        self._waiting.append((time, curvature, tops))
        if len(self._waiting) * len(curvature) >= TOGETHER:
            self._follow_waiting()

    def _follow_waiting(self) -> None:
        if not self._waiting:
            return
        waiting, self._waiting = self._waiting, []
        ranges = radial_range(np.array([curvature for _, curvature, _ in waiting]))
        for (time, curvature, tops), seen in zip(waiting, (ranges >= DEVELOPED).tolist(), strict=True):
            if seen:
                self._follow(time, curvature, (find_lobes(curvature) if tops is None else tops).tolist())

    def _follow(self, time: float, curvature: Array, tops: list[int]) -> None:
        self._points = len(curvature)
        reach = self._points / (2 * max(len(tops), len(self._seen), 1))
        missing, new = _unmatched(self._seen, tops, reach, self._points)
        self._lost += [_Lost(self._time, place, reach) for place in missing]
        self._regain(new)
        self._lost = [lost.judged(curvature, tops) for lost in self._lost]
        self._time, self._seen = time, tops

    def events(self) -> Iterator[LobeEvent]:
        """The losses so far, in order; one whose fate does not show yet stands in a valley, on its way to collapse."""
        self._follow_waiting()
        for lost in self._lost:
            yield LobeEvent(lost.time, 2 * np.pi * lost.place / self._points, lost.fate or Fate.COLLAPSE)

    def _regain(self, new: list[int]) -> None:
        """A lobe that comes back to the place of a lost one was not lost: take the nearest off the list."""
        for top in new:
            near = [lost for lost in self._lost if _distance(top, lost.place, self._points) <= lost.reach]
            if near:
                self._lost.remove(min(near, key=lambda lost: _distance(top, lost.place, self._points)))


def radial_range(curvature: Array) -> Array:
    """[…]: range of the radial displacement w of the circle that has this curvature […, S]: to first order κ - 1 =
    -w'' - w.

    Waves of short length, large in the curvature and invisible in the shape, count little.
    """
    waves = np.fft.rfft(curvature)
    n = np.arange(2, waves.shape[-1])
    waves[..., :2] = 0
    waves[..., 2:] /= n * n - 1
    displacement = np.fft.irfft(waves, curvature.shape[-1])
    return np.asarray(displacement.max(axis=-1) - displacement.min(axis=-1))


def _unmatched(before: list[int], after: list[int], reach: float, points: int) -> tuple[list[int], list[int]]:
    """The places before and after that belong to no pair, nearest pairs first, none further apart than ``reach``."""
    pairs = sorted((_distance(a, b, points), a, b) for a in before for b in after)
    missing, new = list(before), list(after)
    for distance, a, b in pairs:
        if distance <= reach and a in missing and b in new:
            missing.remove(a)
            new.remove(b)
    return missing, new


def _distance(a: int, b: int, points: int) -> int:
    """In samples, the shorter way around the loop."""
    return min((a - b) % points, (b - a) % points)


def _fate(curvature: Array, place: int, tops: list[int]) -> Fate | None:
    """What the curvature [S] shows at the place of a lobe that is not among ``tops`` any more; None: nothing yet."""
    if curvature[place] <= 0:
        return Fate.COLLAPSE
    allowed = VANISHED * float(np.ptp(curvature))
    joined = [_is_one_lobe(_way(curvature, place, step, tops), allowed) for step in (1, -1)]
    return Fate.COALESCENCE if any(joined) and not all(joined) else None


def _way(curvature: Array, place: int, step: int, tops: list[int]) -> Array:
    """The curvature from a place to the next lobe in one direction."""
    points = len(curvature)
    length = min((step * (top - place)) % points for top in tops) if tops else 0
    return curvature[(place + step * np.arange(length + 1)) % points]


def _is_one_lobe(way: Array, allowed: float) -> bool:
    """Whether the way up to a lobe starts high enough on it, and has no valley but for ripples."""
    return bool(way[0] >= SHOULDER * way[-1] and (np.maximum.accumulate(way) - way).max() <= allowed)
