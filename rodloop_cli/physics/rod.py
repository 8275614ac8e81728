"""The rod: its segments, and the mesh of cells laid on them.

Arclength s runs counter-clockwise from 0 to 2π (lengths in R). Segment 1 starts at s = 0. A node stands on every
junction, so that stiffness and density are constant inside a cell.
"""

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Self

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.numerics.gauss import Array

LENGTH = 2 * pi


@dataclass(frozen=True)
class Segment:
    """A uniform piece of rod: its fraction of the arclength, stiffness B/B1 and density ρ/ρ1."""

    fraction: float
    stiffness: float = 1.0
    density: float = 1.0


@dataclass(frozen=True)
class Rod:
    """The segments in the order of s."""

    segments: tuple[Segment, ...] = (Segment(1.0),)

    @property
    def ends(self) -> Array:
        """(segments,): arclength at which each segment ends; the last is 2π exactly."""
        ends = np.cumsum([segment.fraction for segment in self.segments]) * LENGTH
        ends[-1] = LENGTH
        return ends

    @property
    def has_stiffness_contrast(self) -> bool:
        """Whether the unloaded equilibrium is anything but a circle."""
        return len({segment.stiffness for segment in self.segments}) > 1

    def segment_at(self, s: Array) -> NDArray[np.int_]:
        """(S,): index of the segment that holds each s in [0, 2π); a junction belongs to the segment that starts
        there.
        """
        return np.searchsorted(self.ends[:-1], s, side="right")


@dataclass(frozen=True, eq=False)
class Mesh:
    """Cells along the loop.

    edges: (n + 1,) arclength of the nodes, the last one 2π;  segment: (n,) index of each cell's segment;
    stiffness, density: (n,).
    """

    edges: Array
    segment: NDArray[np.int_]
    stiffness: Array
    density: Array

    @classmethod
    def on(cls, rod: Rod, cells_per_segment: tuple[int, ...]) -> Self:
        """Uniform cells in every segment."""
        starts = np.concatenate([[0.0], rod.ends[:-1]])
        pieces = [
            np.linspace(start, end, cells, endpoint=False)
            for start, end, cells in zip(starts, rod.ends, cells_per_segment, strict=True)
        ]
        edges = np.concatenate([*pieces, [LENGTH]])
        return cls._of(rod, edges, np.repeat(np.arange(len(rod.segments)), cells_per_segment))

    @classmethod
    def _of(cls, rod: Rod, edges: Array, segment: NDArray[np.int_]) -> Self:
        stiffness = np.array([s.stiffness for s in rod.segments], dtype=float)[segment]
        density = np.array([s.density for s in rod.segments], dtype=float)[segment]
        return cls(edges, segment, stiffness, density)

    @property
    def cells(self) -> int:
        return len(self.segment)

    @cached_property
    def lengths(self) -> Array:
        """(n,): length of each cell."""
        return np.diff(self.edges)

    def bisected(self, flagged: NDArray[np.bool_]) -> "Mesh":
        """The mesh with every flagged cell halved."""
        middles = (self.edges[:-1] + self.edges[1:]) / 2
        edges = np.sort(np.concatenate([self.edges, middles[flagged]]))
        repeats = np.where(flagged, 2, 1)
        return Mesh(
            edges,
            np.repeat(self.segment, repeats),
            np.repeat(self.stiffness, repeats),
            np.repeat(self.density, repeats),
        )

    def points(self, unit_points: Array) -> Array:
        """(n, points): arclength of points given in the unit cell."""
        return self.edges[:-1, None] + self.lengths[:, None] * unit_points


def cells_by_length(rod: Rod, cells: int) -> tuple[int, ...]:
    """Share out cells by the segments' lengths, each at least one (two nodes make the smallest loop)."""
    shares = [cells * s.fraction for s in rod.segments]
    counts = [max(1 if len(shares) > 1 else 2, int(share)) for share in shares]
    most_wanting = sorted(range(len(shares)), key=lambda i: counts[i] - shares[i])
    for i in most_wanting[: max(0, cells - sum(counts))]:
        counts[i] += 1
    return tuple(counts)
