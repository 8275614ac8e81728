"""Polynomials through values at fixed nodes in [0, 1]: what they and their integrals are anywhere in it.

Held as Chebyshev coefficients, which are well conditioned and cost one cosine to evaluate.
"""

from functools import cache

import numpy as np
from numpy.polynomial import chebyshev

from rodloop_cli.numerics.gauss import Array


class Interpolation:
    """The polynomials through values at ``nodes`` (n,), as weights (k, n) of the values for k points."""

    def __init__(self, nodes: tuple[float, ...]) -> None:
        degree = len(nodes) - 1
        self._values = np.linalg.inv(chebyshev.chebvander(2 * np.array(nodes) - 1, degree))
        self._integrals: Array = np.asarray(chebyshev.chebint(self._values, lbnd=-1, scl=0.5), dtype=float)

    def values(self, points: Array) -> Array:
        """At points (k,) in [0, 1]."""
        return _expanded(points, self._values)

    def integrals(self, points: Array) -> Array:
        """From 0 to points (k,) in [0, 1]."""
        return _expanded(points, self._integrals)


@cache
def interpolation(nodes: tuple[float, ...]) -> Interpolation:
    """Made once for each set of nodes."""
    return Interpolation(nodes)


def _expanded(points: Array, coefficients: Array) -> Array:
    """Sum of T_j(2 point - 1) coefficients[j]: (k, n)."""
    angles = np.arccos(2 * points - 1)
    series: Array = np.cos(np.multiply.outer(angles, np.arange(len(coefficients)))) @ coefficients
    return series
