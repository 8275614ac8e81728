"""The linearised equations of the whole loop as one sparse matrix, with borders for further unknowns and conditions.

The rigid motions are held by pins at node 0: a spring of unit strength between its position and angle and the force and
moment that balance there. A closed loop in equilibrium leaves the pins free of force whatever their strength, so they
change no solution and no criterion of stability; the pinned matrix is singular where the equilibria fold or branch, and
nowhere else.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array
from scipy.sparse.linalg import SuperLU, splu

from rodloop_cli.errors import SingularSystem
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import FX, FY, MOMENT, NODAL, THETA, X, Y

Indices = NDArray[np.int_]


class Border(NamedTuple):
    """One more unknown and one more condition.

    column: (n, 6 + m) what the unknown adds to the equations;  row: (n, 6 + m) gradient of the condition;
    corner: derivative of the condition by this unknown.
    """

    column: Array
    row: Array
    corner: float = 0.0


class _Entries(NamedTuple):
    """Sparse entries: values (K,) at rows (K,) and columns (K,)."""

    rows: Indices
    columns: Indices
    values: Array


def factorized(response: Array, borders: tuple[Border, ...] = (), *, pinned: bool = True) -> SuperLU:
    """LU factors of z_{i+1} - A z_i - B w, w - C z - D w for the cells' ``response`` (n, 6 + m, 6 + m), bordered.

    Raises SingularSystem where it has none.
    """
    places = np.arange(response.shape[0] * response.shape[1]).reshape(response.shape[:2])
    parts = [_own(places, response), _next(places)]
    if pinned:
        parts.append(_pins(places))
    parts += [_border(places.size, i, border) for i, border in enumerate(borders)]
    rows, columns, values = (np.concatenate(pieces) for pieces in zip(*parts, strict=True))
    size = places.size + len(borders)
    try:
        return splu(csc_array((values, (rows, columns)), shape=(size, size)))
    except RuntimeError as error:
        raise SingularSystem("the equations of equilibrium are singular here") from error


def _own(places: Indices, response: Array) -> _Entries:
    rows, columns = np.broadcast_arrays(places[:, :, None], places[:, None, :])
    return _Entries(rows.ravel(), columns.ravel(), -response.ravel())


def _next(places: Indices) -> _Entries:
    """The identity: on the next node's values for the first six rows of a cell, on its own angles for the others."""
    columns = places.copy()
    columns[:, :NODAL] = np.roll(places[:, :NODAL], -1, axis=0)
    return _Entries(places.ravel(), columns.ravel(), np.ones(places.size))


def _pins(places: Indices) -> _Entries:
    return _Entries(places[-1, [FX, FY, MOMENT]], places[0, [X, Y, THETA]], np.ones(3))


def _border(size: int, index: int, border: Border) -> _Entries:
    """Entries of a border; a corner of exactly zero is left out."""
    inner, outer = np.arange(size), np.full(size, size + index)
    corner = np.full(1, size + index)
    return _Entries(
        np.concatenate([inner, outer, corner]),
        np.concatenate([outer, inner, corner]),
        np.concatenate([border.column.ravel(), border.row.ravel(), [border.corner]]),
    )
