"""The balance laws of the loop with nothing unknown but its angles and six constants.

Where `BoxEquations` starts the integrals of (10)-(13) anew in every cell, here they run once round the loop from its
first node. What is left to solve: the angles must be the integral of M/b, and the loop must close (14). On few Gauss
points this is a small full matrix, which costs less than many small ones do.

Newton's iteration is lifted [Albersmeyer & Diehl, SIAM J. Optim. 20 (2010) 1655]: the forces at all points keep the
values that the linearised equations gave them. Forces integrated from the accelerations of an iterate contain its
error times Δt⁻², which the product with the tangent, (13), would spread over the whole loop.

With T the matrix that integrates along the loop, and Δ the differences of angles, the linearised (11)-(13) need two
products of known matrices with cos Δ and sin Δ alone, because d(r_i)·t_j turns into T_jk cos(θ_i - θ_k).

Unknowns are stored as (k, 6 + N): x, y, θ, M, Fx, Fy at the first node, then the angles at all N = n m Gauss points.
"""

from math import pi

import numpy as np

from rodloop_cli.numerics.full import Complex, FullSystems
from rodloop_cli.numerics.gauss import GaussRule
from rodloop_cli.physics.equations import (
    FORCE,
    FX,
    FY,
    MOMENT,
    NODAL,
    NOTHING,
    POSITION,
    THETA,
    Balance,
    Fields,
    Instant,
    Load,
    Motion,
    X,
    Y,
    kinematics,
)
from rodloop_cli.physics.rod import Array, Mesh

_STILL = np.zeros(1)

INTEGRATED = THETA
"""The first of the rows of the residual that are integrals of the shear, see `LoopEquations._from_shear`."""


class LoopEquations(Balance):
    """Eqs. (10)-(13) along the whole loop."""

    def __init__(self, mesh: Mesh, rule: GaussRule, load: Load) -> None:
        super().__init__(mesh, rule, load)
        self._cells, self._points = mesh.cells, mesh.cells * rule.m
        self.size = NODAL + self._points
        self._to_all = integration_matrix(mesh, rule)
        to_points = self._to_all.reshape(self._points, mesh.cells, rule.m + 1)
        self._to_points = np.ascontiguousarray(to_points[:, :, :-1].reshape(self._points, -1).T)
        self._weights = np.ascontiguousarray(self._to_all[:, -1])
        self._prepare()

    def _prepare(self) -> None:
        """Products of integration matrices, which do not change along a run."""
        density = np.repeat(self.mesh.density, self.rule.m)
        compliance = np.repeat(1 / self.mesh.stiffness, self.rule.m)
        to_points, weights = self._to_points, self._weights
        self._mass_before = to_points @ density
        self._mass = float(weights @ density)
        self._twice_mass = to_points * density @ to_points
        self._mass_behind = weights * density @ to_points
        self._twice = to_points @ to_points
        self._length_behind = weights @ to_points
        self._inertia_of_turning = np.diag(density * self.load.rotary_inertia)
        self._from_shear = np.zeros((self.size - INTEGRATED, self._points))
        self._from_shear[THETA - INTEGRATED] = -(weights * compliance) @ to_points
        self._from_shear[MOMENT - INTEGRATED] = -weights
        self._from_shear[NODAL - INTEGRATED :] = -(to_points * compliance) @ to_points
        self._constant = np.zeros((self.size, self.size))
        self._constant[np.arange(NODAL, self.size), np.arange(NODAL, self.size)] = 1.0
        self._constant[THETA, MOMENT] = -(weights @ compliance)
        self._constant[NODAL:, MOMENT] = -(to_points @ compliance)
        self._constant[NODAL:, THETA] = -1.0

    def compressed(self, unknowns: Array) -> Array:
        """(k, 6 + N) from the unknowns of the boxes (k, n, 6 + m)."""
        out = np.empty((len(unknowns), self.size))
        out[:, :NODAL] = unknowns[:, 0, :NODAL]
        out[:, NODAL:].reshape(len(unknowns), self._cells, -1)[...] = unknowns[..., NODAL:]
        return out

    def expanded(self, unknowns: Array, fields: Fields) -> Array:
        """(k, n, 6 + m), the unknowns of the boxes, from those of the loop and their fields."""
        out = np.empty((len(unknowns), self._cells, NODAL + self.rule.m))
        out[:, 0, :NODAL] = unknowns[:, :NODAL]
        out[:, 1:, X], out[:, 1:, Y] = fields.position[..., :-1, -1]
        out[:, 1:, THETA], out[:, 1:, MOMENT] = fields.theta[:, :-1, -1], fields.moment[:, :-1, -1]
        out[:, 1:, FX], out[:, 1:, FY] = fields.force[..., :-1, -1]
        out[..., NODAL:] = self.angles(unknowns)
        return out

    def angles(self, unknowns: Array) -> Array:
        """(k, n, m): a view."""
        return unknowns[:, NODAL:].reshape(len(unknowns), self._cells, -1)

    def _start(self, unknowns: Array, components: slice | int) -> Array:
        start = unknowns[:, components].T
        return start[..., None, None]

    def _integral(self, values: Array) -> Array:
        *instants, cells, m = values.shape
        integral: Array = values.reshape(*instants, cells * m) @ self._to_all
        return integral.reshape(*instants, cells, m + 1)

    def guessed(self, unknowns: Array, force: Array, motion: Motion) -> Fields:
        """Position and motion of a first guess of the unknowns, with a guess of the forces (2, k, n, m + 1)."""
        tangent, position = self.shape(unknowns)
        return Fields(tangent, position, *kinematics(position, motion), force, NOTHING, NOTHING)

    def integrated(self, unknowns: Array, fields: Fields, motion: Motion, instant: Instant) -> Fields:
        """The balances integrated with the forces of ``fields``; by how much these miss their own balance acts on the
        tangent of ``instant``.
        """
        tangent = fields.tangent
        force = self._integral(self._force_density(tangent, fields.velocity, fields.acceleration))
        force += self._start(unknowns, FORCE)
        missing = force - fields.force
        shear = fields.force[0, ..., :-1] * tangent[1]
        shear -= fields.force[1, ..., :-1] * tangent[0]
        shear += missing[0, ..., :-1] * instant.sine
        shear -= missing[1, ..., :-1] * instant.cosine
        moment, theta = self._turning(unknowns, shear, motion)
        return fields._replace(force=force, moment=moment, theta=theta)

    def corrected(
        self, integrated: Fields, unknowns: Array, correction: Array, motion: Motion, instant: Instant
    ) -> Fields:
        """The fields after a ``correction`` that led to ``unknowns``; the forces by their linear response to it."""
        tangent, position = self.shape(unknowns)
        angles = self.angles(correction)
        turned = np.empty_like(tangent)
        np.multiply(angles, -instant.sine, out=turned[0])
        np.multiply(angles, instant.cosine, out=turned[1])
        moved = self._integral(turned)
        moved += self._start(correction, POSITION)
        force = self._integral(self._pressure(turned) + self._resistance(moved, motion, instant))
        force += self._start(correction, FORCE)
        force += integrated.force
        return Fields(tangent, position, *kinematics(position, motion), force, NOTHING, NOTHING)

    def _resistance(self, moved: Array, motion: Motion, instant: Instant) -> Array:
        """(2, k, n, m): change of inertia and drag when the loop is ``moved`` (2, k, n, m + 1)."""
        flat = moved[..., :-1].reshape(*moved.shape[:2], -1)
        velocity = motion.rates @ flat
        shape = (*moved.shape[:-1], -1)
        resistance: Array = self._density * (motion.rates @ velocity).reshape(shape)
        if self.load.zeta_perp:
            tangent = np.stack([instant.cosine, instant.sine])[:, None]
            resistance += self._drag(tangent, velocity.reshape(shape))
        return resistance

    def finished(
        self, integrated: Fields, fields: Fields, correction: Array, motion: Motion, instant: Instant
    ) -> Fields:
        """``fields`` after the last correction, with moments and angles by their linear response to it."""
        gained = fields.force - integrated.force
        shear = gained[0, ..., :-1] * instant.sine
        shear -= gained[1, ..., :-1] * instant.cosine
        along = instant.force[0] * instant.cosine + instant.force[1] * instant.sine
        shear += along * self.angles(correction)
        still = Motion(motion.rates, NOTHING, NOTHING, _STILL, _STILL)
        moment, theta = self._turning(correction, shear, still)
        return fields._replace(moment=integrated.moment + moment, theta=integrated.theta + theta)

    def residual(self, unknowns: Array, fields: Fields) -> Array:
        """(k, 6 + N): by how much the loop fails to close, then the integral of M/b the angle."""
        out = np.empty_like(unknowns)
        out[:, POSITION] = fields.position[..., -1, -1].T
        out[:, FORCE] = fields.force[..., -1, -1].T
        out[:, MOMENT] = fields.moment[:, -1, -1]
        out[:, THETA] = fields.theta[:, -1, -1]
        out[:, THETA] -= 2 * pi
        out[:, NODAL:].reshape(len(out), self._cells, -1)[...] = fields.theta[..., :-1]
        out -= unknowns
        return out

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
        shear = np.zeros((3 if self.load.zeta_perp else 2, self._points, self.size))
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
        """(6 + N,): the response to an extra force density (2, n, m), in the rows of `residual`."""
        force = self._integral(density)
        shear = sine * force[0, :, :-1] - cosine * force[1, :, :-1]
        moment = self._integral(shear)
        turning = self._integral(moment[:, :-1] * self._compliance)
        out = np.zeros(self.size)
        out[FORCE] = force[:, -1, -1]
        out[MOMENT], out[THETA] = moment[-1, -1], turning[-1, -1]
        out[NODAL:] = turning[:, :-1].ravel()
        return out

    def displacement(self, cosine: Array, sine: Array, correction: Array) -> Array:
        """(2, n, m + 1): how far a small ``correction`` (6 + N,) moves the Gauss points and right ends."""
        angles = correction[NODAL:].reshape(cosine.shape)
        moved = self._integral(np.stack([-sine * angles, cosine * angles]))
        moved += correction[POSITION, None, None]
        return moved


def integration_matrix(mesh: Mesh, rule: GaussRule) -> Array:
    """(N, n (m + 1)): ``values @ matrix`` integrates samples (..., N) from s = 0 to the Gauss points and right ends."""
    n, m = mesh.cells, rule.m
    matrix = np.zeros((n, m, n, m + 1))
    for cell, length in enumerate(mesh.lengths):
        matrix[cell, :, cell] = length * rule.to_points_and_end
        matrix[cell, :, cell + 1 :] = length * rule.weights[:, None, None]
    return matrix.reshape(n * m, -1)
