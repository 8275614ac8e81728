"""Values at given arclengths from values on the cells."""

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.numerics.gauss import Array, GaussRule, lagrange_matrix
from rodloop_cli.physics.rod import Mesh

MOST_FULL = 128
"""Values on the cells up to which one full matrix is faster than picking the cell of every point."""


class Sampler:
    """Interpolates inside each cell through its left end, its Gauss points and its right end (order m + 2).

    A point on a junction belongs to the cell that starts there.
    """

    def __init__(self, mesh: Mesh, rule: GaussRule, s: Array) -> None:
        """``s`` (S,) in [0, 2π)."""
        self.cell: NDArray[np.int_] = mesh.edges[1:-1].searchsorted(s, side="right")
        local = (s - mesh.edges[self.cell]) / mesh.lengths[self.cell]
        self._weights = lagrange_matrix(np.concatenate([[0.0], rule.points, [1.0]]), local)
        self._gain = self._weights[:, 0] * (self.cell == 0)
        self._matrix = self._full(mesh.cells) if mesh.cells * (rule.m + 1) <= MOST_FULL else None
        self.stiffness = mesh.stiffness[self.cell]
        self.segment = mesh.segment[self.cell]

    def __call__(self, values: Array, turn: float | Array = 0.0) -> Array:
        """(…, S) from values (…, n, m + 1) at the Gauss points and right ends; ``turn`` (…, 1) is what they gain round
        the loop.
        """
        if self._matrix is not None:
            sampled: Array = values.reshape(*values.shape[:-2], -1) @ self._matrix
        else:
            sampled = values[..., self.cell - 1, -1]
            sampled *= self._weights[:, 0]
            sampled += np.einsum("...sj,sj->...s", values[..., self.cell, :], self._weights[:, 1:])
        sampled -= turn * self._gain
        return sampled

    def _full(self, cells: int) -> Array:
        """(n (m + 1), S): what every value weighs at every point."""
        points, inside = np.arange(len(self.cell)), self._weights[:, 1:]
        matrix = np.zeros((cells, inside.shape[1], len(self.cell)))
        matrix[self.cell, :, points] = inside
        matrix[self.cell - 1, -1, points] += self._weights[:, 0]
        return matrix.reshape(-1, len(self.cell))
