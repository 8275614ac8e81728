"""Positions and velocities from angles and their rates: closed to round-off, inextensible on the mesh, with a given
centre.
"""

import numpy as np

from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import FORCE, NODAL, POSITION, THETA

CLOSED = 1e-15
"""The gap that round-off leaves in a loop of length 2π."""

MOST_STEPS = 4
"""Of Newton's method for the gap: from 1e-2 to round-off."""


class Closure:
    """Integrates (10) around one mesh."""

    def __init__(self, equations: BoxEquations) -> None:
        self._equations = equations
        self._weights = equations.mesh.lengths[:, None] * equations.rule.weights

    def position(self, unknowns: Array, centre: Array) -> Array:
        """(2, n, m + 1); writes nodal positions, and the least change of the angles that closes the loop, into
        ``unknowns``.
        """
        tangent = self._tangent(unknowns)
        for _ in range(MOST_STEPS):
            gap = np.einsum("cnm,nm->c", tangent, self._weights)
            if np.abs(gap).max() < CLOSED:
                break
            unknowns[:, NODAL:] -= self._closing(tangent, gap)
            tangent = self._tangent(unknowns)
        return self._integrate(unknowns, tangent, centre)

    def velocity(self, unknowns: Array, rates: Array, centre: Array) -> Array:
        """(2, n, m + 1) from v' = θ_t n; writes nodal velocities, and the least change that closes the loop, into
        ``rates``.
        """
        tangent = self._tangent(unknowns)
        normal = _normal(tangent)
        gap = np.einsum("cnm,nm,nm->c", normal, rates[:, NODAL:], self._weights)
        rates[:, NODAL:] -= self._closing(tangent, gap)
        return self._integrate(rates, normal * rates[:, NODAL:], centre)

    def centre(self, values: Array) -> Array:
        """(2,): mean over the arclength of a vector (2, n, m + 1)."""
        centre: Array = np.einsum("cnm,nm->c", values[..., :-1], self._weights) / self._weights.sum()
        return centre

    def mean_turn(self, unknowns: Array) -> float:
        """Mean of θ - s: how far the loop as a whole is turned from the circle's orientation."""
        points = self._equations.mesh.points(self._equations.rule.points)
        return float(((unknowns[:, NODAL:] - points) * self._weights).sum() / self._weights.sum())

    def _tangent(self, unknowns: Array) -> Array:
        return self._equations.shape(unknowns)[0]

    def _closing(self, tangent: Array, gap: Array) -> Array:
        """(n, m): the least change of angle (in the mean square) that moves the end of the loop by ``gap``."""
        normal = _normal(tangent)
        gram = np.einsum("cnm,dnm,nm->cd", normal, normal, self._weights)
        change: Array = np.tensordot(np.linalg.solve(gram, gap), normal, 1)
        return change

    def _integrate(self, values: Array, slope: Array, centre: Array) -> Array:
        """Write the nodal integrals of ``slope`` (2, n, m) into ``values`` and return them everywhere."""
        inside = (slope * self._equations.mesh.lengths[:, None]) @ self._equations.rule.to_points_and_end
        nodes = np.cumsum(inside[..., -1], axis=1)
        integral: Array = inside + np.roll(nodes, 1, axis=1)[..., None]
        integral[:, 0] = inside[:, 0]
        integral += (centre - self.centre(integral))[:, None, None]
        values[:, POSITION] = left_ends(integral)
        return integral


def left_ends(values: Array) -> Array:
    """(n, 2): a vector (2, n, m + 1) at the left end of each cell."""
    return np.roll(values[..., -1], 1, axis=-1).T


def turned(unknowns: Array, angle: float) -> Array:
    """The loop turned about the origin by an angle: positions, forces and angles."""
    out = unknowns.copy()
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    for pair in (POSITION, FORCE):
        out[..., pair] = unknowns[..., pair] @ rotation.T
    out[..., THETA] += angle
    out[..., NODAL:] += angle
    return out


def _normal(tangent: Array) -> Array:
    return np.stack([-tangent[1], tangent[0]])
