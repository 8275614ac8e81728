"""Integrals round the whole loop, from its first node, as products with matrices that do not change along a run.

Two orders of places along the loop: by cells, as everywhere, the m Gauss points of each and its right end, n (m + 1)
in all; and, where every product counts, first all N = n m Gauss points and then the n right ends.

Unknowns of the loop: (6 + N,), x, y, θ, M, Fx, Fy at the first node, then the angles at all Gauss points.
"""

from math import pi

import numpy as np

from rodloop_cli.numerics.gauss import Array, GaussRule
from rodloop_cli.physics.equations import MOMENT, NODAL, THETA, Balance, Load
from rodloop_cli.physics.rod import Mesh

INTEGRATED = THETA
"""The first of the rows of the residual that are integrals of the shear, see `LoopIntegrals._from_shear`."""


class LoopIntegrals(Balance):
    """The integrals of (10)-(13).

    points: N;  size: 6 + N unknowns;  by_cells: (n, m + 1) where each place by cells stands in the other order;
    density_at_points: (N,).
    to_position: (N + 1, P) positions at the P = N + n places, from tangents at the points and the start;
    to_force: (2 N + 1, P) forces, from accelerations, forces of the film per length, and the start;
    to_residual: (6 + 2 N + 1, 6 + N) the residual but for its rows of position and force, from the unknowns, the shear
    at the points, and a one.
    """

    def __init__(self, mesh: Mesh, rule: GaussRule, load: Load) -> None:
        super().__init__(mesh, rule, load)
        n, m = mesh.cells, rule.m
        self.points = n * m
        self.size = NODAL + self.points
        self.by_cells = np.column_stack([np.arange(n * m).reshape(n, m), n * m + np.arange(n)])
        self.density_at_points = np.repeat(mesh.density, m)
        self._to_all = integration_matrix(mesh, rule)
        to_places = np.empty((self.points, self.points + n))
        to_places[:, self.by_cells.ravel()] = self._to_all
        # Transposed: rows are the points that are integrated to.
        self._to_points = np.ascontiguousarray(to_places[:, : self.points].T)
        self._weights = np.ascontiguousarray(to_places[:, -1])
        ones = np.ones((1, self.points + n))
        self.to_position = np.concatenate([to_places, ones])
        self.to_force = np.concatenate([self.density_at_points[:, None] * to_places, to_places, ones])
        self._turn_matrices()
        turn = np.zeros((1, self.size))
        turn[0, THETA] = 2 * pi
        from_shear = np.pad(self._from_shear, ((INTEGRATED, 0), (0, 0)))
        self.to_residual = -np.concatenate([self._constant.T, from_shear.T, turn])

    def _turn_matrices(self) -> None:
        """Minus the derivative of the rows of moments and angles, by the shear and by the unknowns directly."""
        compliance = np.repeat(1 / self.mesh.stiffness, self.rule.m)
        to_points, weights = self._to_points, self._weights
        self._from_shear = np.zeros((self.size - INTEGRATED, self.points))
        self._from_shear[THETA - INTEGRATED] = -(weights * compliance) @ to_points
        self._from_shear[MOMENT - INTEGRATED] = -weights
        self._from_shear[NODAL - INTEGRATED :] = -(to_points * compliance) @ to_points
        self._constant = np.zeros((self.size, self.size))
        self._constant[np.arange(NODAL, self.size), np.arange(NODAL, self.size)] = 1.0
        self._constant[THETA, MOMENT] = -(weights @ compliance)
        self._constant[NODAL:, MOMENT] = -(to_points @ compliance)
        self._constant[NODAL:, THETA] = -1.0

    def angles(self, unknowns: Array) -> Array:
        """(k, n, m)."""
        return unknowns[:, NODAL:].reshape(len(unknowns), self.mesh.cells, -1)

    def _start(self, unknowns: Array, component: int) -> Array:
        return unknowns[:, component, None, None]

    def _integral(self, values: Array) -> Array:
        *instants, cells, m = values.shape
        integral: Array = values.reshape(*instants, cells * m) @ self._to_all
        return integral.reshape(*instants, cells, m + 1)


def integration_matrix(mesh: Mesh, rule: GaussRule) -> Array:
    """(N, n (m + 1)): ``values @ matrix`` integrates samples (..., N) from s = 0 to the Gauss points and right ends."""
    n, m = mesh.cells, rule.m
    matrix = np.zeros((n, m, n, m + 1))
    for cell, length in enumerate(mesh.lengths):
        matrix[cell, :, cell] = length * rule.to_points_and_end
        matrix[cell, :, cell + 1 :] = length * rule.weights[:, None, None]
    return matrix.reshape(n * m, -1)
