"""Values at given arclengths from values on the cells."""

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.numerics.gauss import GaussRule, lagrange_matrix
from rodloop_cli.physics.rod import Array, Mesh


class Sampler:
    """Interpolates inside each cell through its left end, its Gauss points and its right end (order m + 2).

    A point on a junction belongs to the cell that starts there.
    """

    def __init__(self, mesh: Mesh, rule: GaussRule, s: Array) -> None:
        """``s`` (S,) in [0, 2π)."""
        self.cell: NDArray[np.int_] = np.clip(np.searchsorted(mesh.edges, s, side="right") - 1, 0, mesh.cells - 1)
        local = (s - mesh.edges[self.cell]) / mesh.lengths[self.cell]
        self._weights = lagrange_matrix(np.concatenate([[0.0], rule.points, [1.0]]), local)
        self._start = self.cell == 0
        self.stiffness = mesh.stiffness[self.cell]
        self.segment = mesh.segment[self.cell]

    def __call__(self, values: Array, turn: float | Array = 0.0) -> Array:
        """(…, S) from values (…, n, m + 1) at the Gauss points and right ends; ``turn`` (…, 1) is what they gain round
        the loop.
        """
        sampled: Array = values[..., self.cell - 1, -1]
        sampled -= turn * self._start
        sampled *= self._weights[:, 0]
        sampled += np.einsum("...sj,sj->...s", values[..., self.cell, :], self._weights[:, 1:])
        return sampled
