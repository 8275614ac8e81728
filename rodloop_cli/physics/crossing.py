"""Does the centreline, taken as a closed polyline, cross itself, and where.

The model has no contact: a loop goes through itself unhindered, and what comes after is not physics. So the test
must not miss and must not cry wolf: it is the exact intersection of the polyline's edges (closed: a vertex that lies
on another edge counts), edge by edge, each against all but itself and its two neighbours. The chords of a curve
lie inside its bends by curvature x spacing^2 / 8, which is the accuracy in position of what is said here.

Arrays are [S] over the vertices in order around the loop, the first not repeated; edge i goes from vertex i to i + 1.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from rodloop_cli.physics.around import following

Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]


def crosses_itself(x: Floats, y: Floats) -> bool:
    """Whether the closed polyline through (x, y), each [S], meets itself anywhere."""
    return not _is_convex(x, y) and len(find_crossings(x, y)) > 0


def find_crossings(x: Floats, y: Floats) -> Floats:
    """Where the closed polyline through (x, y), each [S], meets itself: [K, 2].

    Each row holds the two places along the loop that coincide, first < second, in units of vertices (2.25 is a
    quarter of the way along edge 2); rows ascend by the first.
    """
    x, y = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    first, second = _edges_with_overlapping_boxes(x, y)
    if not first.size:
        return np.empty((0, 2))
    ex, ey = following(x) - x, following(y) - y
    gap_x, gap_y = x[second] - x[first], y[second] - y[first]
    ax, ay, bx, by = ex[first], ey[first], ex[second], ey[second]
    # Sides of the line of one edge on which the two ends of the other lie. With overlapping boxes the edges
    # meet exactly if neither line has both ends of the other edge strictly on one side.
    b_start, b_end = ax * gap_y - ay * gap_x, ax * (gap_y + by) - ay * (gap_x + bx)
    a_start, a_end = by * gap_x - bx * gap_y, by * (gap_x - ax) - bx * (gap_y - ay)
    meet = (_sides(b_start, b_end) <= 0.0) & (_sides(a_start, a_end) <= 0.0)
    places = np.column_stack(
        [first[meet] + _root(a_start[meet], a_end[meet]), second[meet] + _root(b_start[meet], b_end[meet])]
    )
    return places[np.argsort(places[:, 0], kind="stable")]


def _sides(start: Floats, end: Floats) -> Floats:
    """Product of signs: 1 if both ends lie strictly on one side. Not the product itself, which may underflow."""
    return np.sign(start) * np.sign(end)


def _root(start: Floats, end: Floats) -> Floats:
    """Where a linear function with these end values vanishes, in [0, 1]; 1/2 if it vanishes throughout."""
    change = start - end
    return np.divide(start, change, out=np.full_like(start, 0.5), where=change != 0.0)


def star_shaped(polygons: Floats) -> npt.NDArray[np.bool_]:
    """[...]: whether closed polylines [2, ..., S] go forward at every edge, as seen from the mean of their vertices.

    Those that turn round once in all, as the loop does, cannot meet themselves then: they go around that place once,
    for shrinking all distances from it to one another turns them into a circle without a halt.
    """
    arms = polygons - polygons.sum(axis=-1, keepdims=True) / polygons.shape[-1]
    ends = np.concatenate([arms[..., 1:], arms[..., :1]], axis=-1)
    forward = arms[0] * ends[1]
    forward -= arms[1] * ends[0]
    return np.asarray(forward.min(axis=-1) > 0.0)


def _is_convex(x: Floats, y: Floats) -> bool:
    """Whether the polyline turns left at every vertex and once around in all: then it cannot meet itself."""
    ex, ey = following(x) - x, following(y) - y
    turning = ex * following(ey) - ey * following(ex)
    if not (turning > 0.0).all():
        return False
    upward = ey > 0.0
    return int(np.count_nonzero(upward != following(upward))) == 2


def _edges_with_overlapping_boxes(x: Floats, y: Floats) -> tuple[Indices, Indices]:
    """Pairs of edges, first < second, not neighbours, whose bounding boxes touch.

    Found by sweeping along x: sorted by their left end, the edges whose boxes can touch that of one edge are
    those that follow it up to its right end; some 5 S pairs for a smooth loop rather than S^2 / 2.
    """
    left, right = _interval(x)
    bottom, top = _interval(y)
    order = np.argsort(left, kind="stable")
    after = np.arange(1, len(x) + 1)
    followers = np.searchsorted(left[order], right[order], side="right") - after
    one = np.repeat(order, followers)
    other = order[np.arange(len(one)) + np.repeat(after - np.cumsum(followers) + followers, followers)]
    i, j = np.minimum(one, other), np.maximum(one, other)
    keep = (bottom[i] <= top[j]) & (bottom[j] <= top[i]) & (j - i > 1) & (j - i < len(x) - 1)
    return i[keep], j[keep]


def _interval(values: Floats) -> tuple[Floats, Floats]:
    ends = following(values)
    return np.minimum(values, ends), np.maximum(values, ends)
