"""Polynomials through values at fixed nodes in [0, 1]: what they and their integrals are anywhere in it.

Held as Chebyshev coefficients, which are well conditioned and cost one cosine to evaluate.
"""

from functools import cache

import numpy as np
from numpy.polynomial import chebyshev

from rodloop_cli.numerics.gauss import Array


class Interpolation:
    """The polynomials through values at ``nodes`` (n,).

    values, integrals: (n, n) and (n + 1, n), what turns a `series` at k points into the weights (k, n) of the values
    for the polynomial there and for its integral from 0 to there.
    """

    def __init__(self, nodes: tuple[float, ...]) -> None:
        degree = len(nodes) - 1
        self.values = np.linalg.inv(chebyshev.chebvander(2 * np.array(nodes) - 1, degree))
        self.integrals: Array = np.asarray(chebyshev.chebint(self.values, lbnd=-1, scl=0.5), dtype=float)


@cache
def interpolation(nodes: tuple[float, ...]) -> Interpolation:
    """Made once for each set of nodes."""
    return Interpolation(nodes)


def series(points: Array, terms: int) -> Array:
    """(k, terms): T_j(2 point - 1) for points (k,) in [0, 1]."""
    angles = np.arccos(2 * points - 1)
    polynomials: Array = np.cos(angles[:, None] * np.arange(terms))
    return polynomials
