"""Energies of the loop and the power the film takes, as in Eqs. (15) and (16); B1/R and its rate, absolute.

All integrals use the Gauss weights of the collocation, which makes them as accurate as the nodal values. Arrays carry
any leading dimensions …; on Gauss points they end in (n, m).
"""

import numpy as np

from rodloop_cli.numerics.gauss import Array, GaussRule
from rodloop_cli.physics.equations import Load
from rodloop_cli.physics.rod import Mesh


class Quadrature:
    """Integrals around the loop of quantities given at the Gauss points."""

    def __init__(self, mesh: Mesh, rule: GaussRule) -> None:
        weights = mesh.lengths[:, None] * rule.weights
        self._weights = weights.ravel()
        self._compliance = (weights / mesh.stiffness[:, None]).ravel()
        self._mass = (weights * mesh.density[:, None]).ravel()

    def integral(self, density: Array) -> Array:
        """∮ density ds for density (…, n, m)."""
        return _summed(density, self._weights)

    def area(self, position: Array, tangent: Array) -> Array:
        """½ ∮ (x sin θ - y cos θ) ds for position, tangent (2, …, n, m); negative where the loop is inside out."""
        return self.integral(position[0] * tangent[1] - position[1] * tangent[0]) / 2

    def area_rate(self, velocity: Array, tangent: Array) -> Array:
        """∮ (u sin θ - v cos θ) ds: how fast the area grows."""
        return self.integral(velocity[0] * tangent[1] - velocity[1] * tangent[0])

    def bending(self, moment: Array) -> Array:
        """∮ M²/(2b) ds for moment (…, n, m)."""
        return _summed(moment * moment, self._compliance) / 2

    def kinetic(self, velocity: Array) -> Array:
        """∮ ρ v²/2 ds for velocity (2, …, n, m)."""
        return _summed(_square(velocity), self._mass) / 2

    def rotary(self, spin: Array, rotary_inertia: float) -> Array:
        """∮ ρ ι θ_t²/2 ds for spin θ_t (…, n, m): the kinetic energy of the turning cross-sections."""
        return _summed(spin**2, self._mass) * (rotary_inertia / 2)

    def dissipation_rate(self, velocity: Array, tangent: Array, load: Load) -> Array:
        """ζ⊥ ∮ (v_n² + γ v_t²) ds, Eq. (16)."""
        if load.zeta_perp == 0:
            return np.zeros(velocity.shape[1:-2])
        along = velocity[0] * tangent[0]
        along += velocity[1] * tangent[1]
        along *= along
        along *= load.gamma - 1
        along += _square(velocity)
        return load.zeta_perp * self.integral(along)


def _square(vectors: Array) -> Array:
    """(…) from vectors (2, …)."""
    squares = vectors * vectors
    squares[0] += squares[1]
    square: Array = squares[0]
    return square


def _summed(values: Array, weights: Array) -> Array:
    """(…) from values (…, n, m) and weights (n m,)."""
    total: Array = values.reshape(*values.shape[:-2], -1) @ weights
    return total
