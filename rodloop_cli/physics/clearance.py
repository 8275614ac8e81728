"""How far the centreline is from crossing itself: a continuous number whose zero is the first contact.

Two strands of a simple closed curve can only meet for the first time with opposite tangents: the inside of the loop is
on the left of both, and before they touch there is either inside or outside between them, not one on one face and
the other on the other. That holds for opposite sides of the loop that meet in the middle (film ruptured outside) and
for neighbouring lobes that meet from outside. So

* while the curve is simple, the number is the least distance between places with opposed tangents (tangent vectors
  with a negative product), which leaves out what is near merely because it follows along the curve;
* once it crosses, the strands overlap in a lens (between two crossings that follow one another on both strands),
  and the number is minus the lens's thickness: the greatest distance of a vertex on its rim from the opposite rim.

Both go to zero in proportion to the distance still to go, so a root finder gets the time of contact in few steps.
Far from contact only the sign means anything: the distance may jump where strands begin to be opposed.
"""

from __future__ import annotations

import math
import sys

import numpy as np

from rodloop_cli.physics.around import following
from rodloop_cli.physics.crossing import Floats, Indices, find_crossings

ROUND_OFF = 1e-14
"""Of squared distances, which are differences of squares of order one."""

Arc = tuple[float, float]
"""Two places along the loop in units of vertices, as in `find_crossings`."""


def crossing_indicator(x: Floats, y: Floats) -> float:
    """Distance (in R) to self-contact of the closed polyline (x, y), each [S]; <= 0 if it meets itself."""
    points = np.column_stack([x, y]).astype(np.float64)
    places = find_crossings(points[:, 0], points[:, 1])
    return -_overlap(points, places) if len(places) else _clearance(points)


def least_clearance(x: Floats, y: Floats) -> float:
    """A lower bound of `crossing_indicator` for a polyline that does not meet itself, quicker to find.

    Vertices count as opposed if their neighbours may be; so the nearer end of every edge that matters is among them.
    """
    points = np.column_stack([x, y]).astype(np.float64)
    edges = following(points) - points
    tangents = edges + _preceding(edges)
    turning = _longest(tangents - _preceding(tangents)) * _longest(tangents)
    least = _squared_distances(points, tangents, math.sqrt(turning)).min() - _short_of(edges) - ROUND_OFF
    return math.sqrt(max(0.0, float(least)))


def _clearance(points: Floats) -> float:
    """Least distance from a vertex to an edge, among those with opposed tangents; `points` [S, 2]."""
    edges = following(points) - points
    squared = _squared_distances(points, edges + _preceding(edges))
    reach = squared.min() + _short_of(edges) + ROUND_OFF
    i, j = np.divmod(np.flatnonzero(squared <= min(reach, sys.float_info.max)), len(points))
    ahead = _distance_to_edges(points[i], points[j], edges[j])
    behind = _distance_to_edges(points[i], points[j - 1], edges[j - 1])
    return float(min(ahead.min(initial=np.inf), behind.min(initial=np.inf)))


def _squared_distances(points: Floats, tangents: Floats, opposed: float = 0.0) -> Floats:
    """Between the vertices, [S, S]; infinite unless the product of the tangents is below ``opposed``.

    Neighbours do not count either: a sharp bend may oppose their tangents.
    """
    size, square = len(points), (points * points).sum(axis=1)
    one, other = np.ones((size, 4)), np.ones((4, size))
    one[:, :2], one[:, 2] = points, square
    other[:2], other[3] = -2 * points.T, square
    squared = np.asarray(one @ other)
    squared[tangents @ tangents.T.copy() >= opposed] = np.inf
    entries = squared.reshape(-1)
    for first in (0, 1, size):
        entries[first :: size + 1] = np.inf
    squared[0, -1] = squared[-1, 0] = np.inf
    return squared


def _preceding(values: Floats) -> Floats:
    return np.concatenate([values[-1:], values[:-1]])


def _longest(vectors: Floats) -> float:
    """The square of the length of the longest of `vectors` [S, 2]."""
    return float((vectors * vectors).sum(axis=1).max())


def _short_of(edges: Floats) -> float:
    """How much less the square of the distance to an edge may be than that to the vertex at its nearer end, which is
    at most half an edge away.
    """
    return _longest(edges) / 4


def _distance_to_edges(points: Floats, starts: Floats, edges: Floats) -> Floats:
    """Distance [...] of `points` [..., 2] from the edges that begin at `starts`; shapes broadcast."""
    offset = points - starts
    length = np.maximum((edges * edges).sum(axis=-1), np.finfo(np.float64).tiny)
    along = np.clip((offset * edges).sum(axis=-1) / length, 0.0, 1.0)
    return np.asarray(np.hypot(*np.moveaxis(offset - along[..., None] * edges, -1, 0)))


def _overlap(points: Floats, places: Floats) -> float:
    """Depth of the deepest lens; without one (a figure of eight) size of the smallest loop. `places` [K, 2]."""
    lenses = _lenses(places)
    if lenses:
        return max(_thickness(points, one, other) for one, other in lenses)
    return min(_loop_size(points, first, second) for first, second in places.tolist())


def _lenses(places: Floats) -> list[tuple[Arc, Arc]]:
    """The pairs of arcs between two crossings that follow one another on both strands, in opposite senses."""
    # Each crossing is met twice along the loop; `other` is the number of the other meeting in the same crossing.
    order = np.argsort(places.ravel(), kind="stable")
    at = places.ravel()[order]
    other = np.argsort(order)[order ^ 1]
    following = np.roll(np.arange(len(at)), -1)
    back = other[following]
    found = (following[back] == other) & (back > np.arange(len(at)))
    return [((at[k], at[following[k]]), (at[back[k]], at[other[k]])) for k in np.flatnonzero(found)]


def _thickness(points: Floats, one: Arc, other: Arc) -> float:
    """Greatest distance of a vertex of either arc from the other arc."""
    return max(_farthest(points, one, other), _farthest(points, other, one))


def _farthest(points: Floats, arc: Arc, rim: Arc) -> float:
    vertices, starts = _vertices(arc, len(points)), _edges(rim, len(points))
    edges = points[(starts + 1) % len(points)] - points[starts]
    distances = _distance_to_edges(points[vertices][:, None], points[starts], edges)
    return float(distances.min(axis=1).max(initial=0.0))


def _loop_size(points: Floats, first: float, second: float) -> float:
    """Greatest distance from the crossing to a vertex of the shorter way around from it to itself."""
    size = len(points)
    edge = int(first) % size
    crossing = points[edge] + (first - int(first)) * (points[(edge + 1) % size] - points[edge])
    arc = (first, second) if second - first <= 0.5 * size else (second, first)
    away = points[_vertices(arc, size)] - crossing
    return float(np.hypot(away[:, 0], away[:, 1]).max(initial=0.0))


def _vertices(arc: Arc, size: int) -> Indices:
    """Indices of the vertices on an arc, whose end may lie before its start around the loop of `size` vertices."""
    start, end = arc
    end += size if end < start else 0
    return np.arange(math.ceil(start), math.floor(end) + 1) % size


def _edges(arc: Arc, size: int) -> Indices:
    """Indices of the edges that an arc runs over, wholly or in part."""
    start, end = arc
    end += size if end < start else 0
    return np.arange(math.floor(start), max(math.ceil(end), math.floor(start) + 1)) % size
