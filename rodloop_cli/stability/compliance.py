"""The linearised motion about an equilibrium as a symmetric eigenproblem.

A small motion u(s) e^{λt} without drag is the response to its own inertia: with K0 the linearised statics and L1 the
response to inertia,

    K0 x = λ² L1 x = λ² R(ρ u),    u = P x,

R the cells' response to a force density and P the displacement that belongs to the unknowns x. About a shift σ: (K0 - σ
L1) x = (λ² - σ) R(ρ u). The sparse factors of K0 - σ L1 are applied to a unit force at every Gauss point; scaled with
the masses D² = ρ w there (w the weights of the arclength), the response

    S = D P (K0 - σ L1)⁻¹ R D⁻¹ ρ,    S v = v / (λ² - σ),    v = D u

is symmetric, to round-off, because Gauss collocation is: every eigenvalue is real and every multiple one is found as
often as it occurs.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import NODAL
from rodloop_cli.statics.bordered import factorized
from rodloop_cli.statics.loaded import Loaded

IMMOBILE = 1e-11
"""Eigenvalues of S below this share of the largest belong to motions that stretch the rod: half of them are exactly
zero.
"""

LEADING = 1e-5
"""The same where only the eigenvalues λ² nearest to zero matter: holding the area turns one into round-off of nearly
this size.
"""

UNCHANGEABLE = 1e-10
"""A loop whose area responds to pressure by less than this, relative to other responses, is a circle: its area is the
largest.
"""


@dataclass(frozen=True, eq=False)
class Compliance:
    """S about the shift σ, without the neutral motions: the rigid ones, and the sliding of a uniform rod along its
    shape.

    The neutral motions are eigenvectors with λ² = 0; moved to the eigenvalue 0 of S, they are out of the spectrum.
    """

    loop: Loaded
    shift: float

    @cached_property
    def corrections(self) -> Array:
        """(N, 2nm): changes of the unknowns under a unit force at each Gauss point, N = n (6 + m)."""
        still, inertia = self.loop.responses
        factors = factorized(still + self.shift * inertia, pinned=False)
        corrections: Array = factors.solve(_unit_forces(self.loop))
        return corrections

    @cached_property
    def root_mass(self) -> Array:
        """(2nm,): D, by which displacements at the Gauss points are scaled."""
        mass = self.loop.weights * self.loop.equations.mesh.density[:, None]
        return np.tile(np.sqrt(mass).ravel(), 2)

    @cached_property
    def density(self) -> Array:
        """(2nm,): ρ at the Gauss points."""
        return np.tile(np.repeat(self.loop.equations.mesh.density, self.loop.weights.shape[1]), 2)

    @cached_property
    def neutral(self) -> Array:
        """(2nm, 3 or 4): orthonormal neutral motions, scaled with D; the first three rigid."""
        x, y = self.loop.position.reshape(2, -1)
        one, zero = np.ones_like(x), np.zeros_like(x)
        motions = [np.stack([one, zero]), np.stack([zero, one]), np.stack([-y, x])]
        if self.loop.relabelling is not None:
            motions.append(self.loop.relabelling[0].reshape(2, -1))
        return np.asarray(np.linalg.qr((np.stack(motions).reshape(len(motions), -1) * self.root_mass).T)[0])

    @cached_property
    def matrix(self) -> Array:
        """(2nm, 2nm): S."""
        n, size = self.loop.unknowns.shape
        rows, columns = self.loop.position_rows, self.corrections.reshape(n, size, -1)
        moved = np.concatenate([np.matmul(rows[c], columns).reshape(-1, columns.shape[-1]) for c in range(2)])
        scaled = self.root_mass[:, None] * moved * (self.density / self.root_mass)
        matrix: Array = (scaled + scaled.T) / 2 + self.neutral @ self.neutral.T / self.shift
        return matrix

    @property
    def at_fixed_area(self) -> Array:
        """(2nm, 2nm): S of the motions that keep the enclosed area."""
        cosine, sine = self.loop.tangent
        outward = np.stack([sine, -cosine]).ravel() * np.tile(self.loop.weights.ravel(), 2) / self.root_mass
        bulge = self.matrix @ outward
        growth = float(outward @ bulge)
        if abs(growth) < UNCHANGEABLE * float(outward @ outward) * float(np.abs(self.matrix).max()):
            return self.matrix
        held: Array = self.matrix - np.outer(bulge, bulge) / growth
        return held

    def squares(self, matrix: Array) -> Array:
        """Descending λ² of the slow motions, by the eigenvalues of S or of S at fixed area."""
        values = np.linalg.eigvalsh(matrix)
        slow = values[np.abs(values) > LEADING * np.abs(values).max()]
        return np.sort(self.shift + 1 / slow)[::-1]

    @cached_property
    def eigenpairs(self) -> tuple[Array, Array]:
        """λ² (J,), descending, and v (2nm, J), orthonormal."""
        values, vectors = np.linalg.eigh(self.matrix)
        mobile = np.abs(values) > IMMOBILE * np.abs(values).max()
        squares = self.shift + 1 / values[mobile]
        order = np.argsort(-squares)
        return squares[order], vectors[:, mobile][:, order]

    def corrections_of(self, square: float, vector: Array) -> Array:
        """(n, 6 + m): change of the unknowns in the motion v (2nm,) with its λ²."""
        force = (square - self.shift) * self.density * vector / self.root_mass
        return (self.corrections @ force).reshape(self.loop.unknowns.shape)


def _unit_forces(loop: Loaded) -> Array:
    """(N, 2nm): the cells' response to a unit force density at one Gauss point (component by component, cell by cell).
    (N, 2nm): the cells' response to a unit force density at one Gauss point (component by component, cell by cell).
    """
    n, size = loop.unknowns.shape
    points = size - NODAL
    forces = np.zeros((n, size, 2, n, points))
    cells = np.arange(n)
    for component in range(2):
        for point in range(points):
            density = np.zeros((2, n, points))
            density[component, :, point] = 1.0
            forces[cells, :, component, cells, point] = loop.response_to(density)
    return forces.reshape(n * size, 2 * n * points)
