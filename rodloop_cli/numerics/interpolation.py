"""Polynomials through values at fixed nodes in [0, 1]: what they and their integrals are anywhere in it.

Held as Chebyshev coefficients, which are well conditioned and cost one cosine to evaluate.
"""

from functools import cache
from typing import NamedTuple

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


class StepWeights(NamedTuple):
    """What the values at the start of a step (0) and at its stages (s,) weigh at k points of the step.

    stages: (k, s) for the polynomial through the stages alone;  values, integrals: (k, 1 + s) for the one through the
    start and the stages, and for its integral from the start.
    """

    stages: Array
    values: Array
    integrals: Array


def step_weights(stages: tuple[float, ...], points: Array) -> StepWeights:
    """The weights for ``points`` (k,) in [0, 1] of a step with ``stages`` (s,), all from one product."""
    s = len(stages)
    weights = series(points, s + 2) @ _side_by_side(stages)
    return StepWeights(weights[:, :s], weights[:, s : 2 * s + 1], weights[:, 2 * s + 1 :])


@cache
def _side_by_side(stages: tuple[float, ...]) -> Array:
    """(s + 2, 3 s + 2): what turns a `series` into the weights of `StepWeights`."""
    s, by_stages, by_all = len(stages), interpolation(stages), interpolation((0.0, *stages))
    matrix = np.zeros((s + 2, 3 * s + 2))
    matrix[:s, :s] = by_stages.values
    matrix[: s + 1, s : 2 * s + 1] = by_all.values
    matrix[:, 2 * s + 1 :] = by_all.integrals
    return matrix


def series(points: Array, terms: int) -> Array:
    """(k, terms): T_j(2 point - 1) for points (k,) in [0, 1]."""
    angles = np.arccos(2 * points - 1)
    polynomials: Array = np.cos(angles[:, None] * _degrees(terms))
    return polynomials


@cache
def _degrees(terms: int) -> Array:
    return np.arange(float(terms))
