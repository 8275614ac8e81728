"""Gauss-Legendre collocation on the unit cell [0, 1].

One-stage collocation is the midpoint ("Keller") box; with m points the nodal values are accurate to order 2m
[Hairer & Wanner, Solving ODEs II, IV.5].
"""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class GaussRule:
    """An m-point Gauss rule with the matrices that integrate and interpolate inside a cell.

    points: (m,) Gauss points in (0, 1);  weights: (m,);
    to_points: (m, m), ``f @ to_points`` integrates samples f (..., m) from 0 to each point;
    legendre: (m, m), ``f @ legendre`` are the coefficients of f in the Legendre polynomials P_0 … P_{m-1} of the cell.
    """

    points: Array
    weights: Array
    to_points: Array
    legendre: Array

    @property
    def m(self) -> int:
        return len(self.points)

    @cached_property
    def to_points_and_end(self) -> Array:
        """(m, m + 1): integrals from 0 to each Gauss point and, in the last column, to 1."""
        return np.column_stack([self.to_points, self.weights])


@cache
def gauss_rule(m: int) -> GaussRule:
    """The m-point rule, m >= 1."""
    nodes, weights = legendre.leggauss(m)
    vandermonde = legendre.legvander(nodes, m - 1)
    samples_to_coefficients = np.linalg.inv(vandermonde)
    antiderivatives = legendre.legint(samples_to_coefficients, lbnd=-1, axis=0)
    to_points = (legendre.legvander(nodes, m) @ antiderivatives).T / 2
    return GaussRule((nodes + 1) / 2, weights / 2, to_points, np.array(samples_to_coefficients.T, dtype=float))


def lagrange_matrix(nodes: Array, points: Array) -> Array:
    """(points, nodes): values of the Lagrange basis on ``nodes`` at ``points``, by the barycentric formula.

    A point on a node gets that node's value exactly.
    """
    distance = np.subtract.outer(points, nodes)
    on_node = distance == 0
    distance[on_node] = 1.0
    gaps = np.subtract.outer(nodes, nodes)
    gaps.flat[:: len(nodes) + 1] = 1.0
    basis: Array = distance.prod(axis=1)[:, None] / (distance * gaps.prod(axis=1))
    hits = on_node.any(axis=1)
    if hits.any():
        basis[hits] = on_node[hits]
    return basis


def lagrange_derivative(nodes: Array, points: Array) -> Array:
    """(points, nodes): derivatives of the Lagrange basis on ``nodes`` at ``points``."""
    degree = len(nodes) - 1
    scaled = 2 * (np.concatenate([nodes, points]) - nodes.min()) / np.ptp(nodes) - 1
    vandermonde = legendre.legvander(scaled[: len(nodes)], degree)
    slopes = np.stack([legendre.legval(scaled[len(nodes) :], legendre.legder(row)) for row in np.eye(degree + 1)], 1)
    derivative: Array = np.linalg.solve(vandermonde.T, slopes.T).T * 2 / np.ptp(nodes)
    return derivative
