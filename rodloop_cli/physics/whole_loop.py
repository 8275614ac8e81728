"""The balance laws of the loop with nothing unknown but its angles and six constants.

Where `BoxEquations` starts the integrals of (10)-(13) anew in every cell, here they run once round the loop from its
first node. What is left to solve: the angles must be the integral of M/b, and the loop must close (14). On few Gauss
points this is a small full matrix, which costs less than many small ones do.

With T the matrix that integrates along the loop, and Δ the differences of angles, the linearised (11)-(13) need two
products of known matrices with cos Δ and sin Δ alone, because d(r_i)·t_j turns into T_jk cos(θ_i - θ_k).

The order of the unknowns is that of `loop_integrals`.
"""

import numpy as np

from rodloop_cli.numerics.full import Complex, FullSystems
from rodloop_cli.numerics.gauss import Array, GaussRule
from rodloop_cli.physics.equations import (
    FORCE,
    FX,
    FY,
    NODAL,
    POSITION,
    Load,
    Motion,
    X,
    Y,
)
from rodloop_cli.physics.lifted import LoopIterate
from rodloop_cli.physics.loop_integrals import INTEGRATED, LoopIntegrals
from rodloop_cli.physics.rod import Mesh


class LoopEquations(LoopIntegrals):
    """Eqs. (10)-(13) along the whole loop."""

    def __init__(self, mesh: Mesh, rule: GaussRule, load: Load) -> None:
        super().__init__(mesh, rule, load)
        density, to_points, weights = self.density_at_points, self._to_points, self._weights
        self._mass_before = to_points @ density
        self._mass = float(weights @ density)
        self._twice_mass = to_points * density @ to_points
        self._mass_behind = weights * density @ to_points
        self._twice = to_points @ to_points
        self._length_behind = weights @ to_points
        self._inertia_of_turning = np.diag(density * load.rotary_inertia)

    def iterate(self, unknowns: Array, force: Array, motion: Motion) -> LoopIterate:
        """Newton's first iterate of the stages, from a guess of the unknowns of the boxes (s, n, 6 + m), of which the
        angles and the first node are taken, and of the forces (2, s, n, m + 1).
        """
        return LoopIterate(self, unknowns, force, motion)

    def linearise(self, cosine: Array, sine: Array, force: Array, velocity: Array) -> Array:
        """(3 or 2, 6 + N, 6 + N): parts A0, A1[, A2] of the matrix A0 + λ² A1 + λ A2 of minus the residual.

        λ stands for the time derivative; A2 is there only with drag. Arguments at one instant: cosine, sine (n, m);
        force, velocity (2, n, m).
        """
        c, s = cosine.ravel(), sine.ravel()
        turned = np.multiply.outer(c + 1j * s, c - 1j * s)
        cosine_between, sine_between = turned.real, self._to_points * turned.imag
        velocity = velocity.reshape(2, -1)
        shear = self._shear_response(c, s, cosine_between, sine_between)
        shear[0].reshape(-1)[NODAL :: self.size + 1] += force[0].ravel() * c + force[1].ravel() * s
        if self.load.zeta_perp:
            self._add_drag_response(shear, c, s, velocity, cosine_between, sine_between)
        matrix = np.zeros((len(shear), self.size, self.size))
        np.matmul(self._from_shear, shear, out=matrix[:, INTEGRATED:])
        matrix[0] += self._constant
        self._add_closure(matrix, c, s)
        if self.load.zeta_perp:
            self._add_drag_force(matrix, c, s, velocity, sine_between)
        return matrix

    def _shear_response(self, c: Array, s: Array, cosine_between: Array, sine_between: Array) -> Array:
        """(3 or 2, N, 6 + N): response of Fx sin θ - Fy cos θ to the unknowns, by the forces of film and inertia."""
        angles = np.s_[NODAL:]
        shear = np.zeros((3 if self.load.zeta_perp else 2, self.points, self.size))
        np.multiply(sine_between, self.load.p, out=shear[0, :, angles])
        shear[0, :, FX] = s
        np.negative(c, out=shear[0, :, FY])
        np.multiply(self._mass_before, s, out=shear[1, :, X])
        np.multiply(self._mass_before, -c, out=shear[1, :, Y])
        np.multiply(self._twice_mass, -cosine_between, out=shear[1, :, angles])
        if self.load.rotary_inertia:
            shear[1, :, angles] += self._inertia_of_turning
        return shear

    def _add_closure(self, matrix: Array, c: Array, s: Array) -> None:
        """The rows of position and force at the end of the loop."""
        angles = np.s_[NODAL:]
        np.multiply(self._weights, s, out=matrix[0, X, angles])
        np.multiply(self._weights, -c, out=matrix[0, Y, angles])
        np.multiply(matrix[0, Y, angles], self.load.p, out=matrix[0, FX, angles])
        np.multiply(matrix[0, X, angles], -self.load.p, out=matrix[0, FY, angles])
        np.multiply(self._mass_behind, s, out=matrix[1, FX, angles])
        np.multiply(self._mass_behind, -c, out=matrix[1, FY, angles])
        matrix[1, FX, X] = matrix[1, FY, Y] = -self._mass

    def factored(self, rates: Complex, cosine: Array, sine: Array, force: Array, velocity: Array) -> FullSystems:
        """The factored systems for time derivatives λ in ``rates`` (E,), the first of which is real; the other
        arguments are those of `linearise`. Raises SingularSystem.
        """
        return FullSystems(self.linearise(cosine, sine, force, velocity), rates)

    def _add_drag_response(
        self, shear: Array, c: Array, s: Array, velocity: Array, cosine_between: Array, sine_between: Array
    ) -> None:
        """To the response of the shear: that of the drag's integrals to velocities (part 2) and to angles (part 0)."""
        zeta, excess, angles = self.load.zeta_perp, self._excess, np.s_[NODAL:]
        length_before = zeta * self._to_points.sum(axis=1)
        shear[2, :, X] = length_before * s + excess * (sine_between @ c)
        shear[2, :, Y] = -length_before * c + excess * (sine_between @ s)
        shear[2, :, angles] = -zeta * self._twice * cosine_between + excess * (sine_between @ sine_between)
        turning = self._drag_by_angle(c, s, velocity)
        shear[0, :, angles] += self._to_points * (s[:, None] * turning[0] - c[:, None] * turning[1])

    def _add_drag_force(self, matrix: Array, c: Array, s: Array, velocity: Array, sine_between: Array) -> None:
        """The same for the forces at the end of the loop."""
        zeta, angles = self.load.zeta_perp, np.s_[NODAL:]
        tangent, across = np.stack([c, s]), np.stack([-s, c])
        weighted = self._excess * self._weights * tangent
        matrix[0, FORCE, angles] -= self._weights * self._drag_by_angle(c, s, velocity)
        matrix[2, FORCE, POSITION] = -weighted @ tangent.T - zeta * self._weights.sum() * np.eye(2)
        matrix[2, FORCE, angles] = -zeta * self._length_behind * across - weighted @ sine_between

    @property
    def _excess(self) -> float:
        return self.load.zeta_perp * (self.load.gamma - 1)

    def _drag_by_angle(self, c: Array, s: Array, velocity: Array) -> Array:
        """(2, N): derivative of the drag by the angle at its point."""
        u, v = velocity
        cross, square = 2 * s * c, c * c - s * s
        return self._excess * np.stack([square * v - cross * u, square * u + cross * v])

    def load_response(self, cosine: Array, sine: Array, density: Array) -> Array:
        """(6 + N,): the response to an extra force density (2, n, m), in the rows of `LoopIterate.residual`."""
        force = density.reshape(2, -1) @ self._to_all
        points = force.reshape(2, self.mesh.cells, -1)[..., :-1]
        shear = sine * points[0]
        shear -= cosine * points[1]
        out = np.zeros(self.size)
        np.matmul(self._from_shear, -shear.ravel(), out=out[INTEGRATED:])
        out[FORCE] += force[:, -1]
        return out

    def displacement(self, cosine: Array, sine: Array, correction: Array) -> Array:
        """(2, n (m + 1)): how far a small ``correction`` (6 + N,) moves the Gauss points and right ends."""
        angles = correction[NODAL:]
        turned = np.empty((2, len(angles)))
        np.multiply(sine.ravel(), -angles, out=turned[0])
        np.multiply(cosine.ravel(), angles, out=turned[1])
        moved: Array = turned @ self._to_all
        moved += correction[POSITION, None]
        return moved
