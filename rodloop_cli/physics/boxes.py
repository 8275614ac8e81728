"""The balance laws on Gauss boxes: residual and exact linearisation.

In a cell the only free values are the angles Θ at the m Gauss points and the six nodal values at its left end:
position, force and moment follow by integration. What is left to solve: Θ must be the integral of M/b, and each cell
must end where the next begins (14).

Unknowns are stored cell by cell, (..., n, 6 + m): x, y, θ, M, Fx, Fy at the left node, then Θ_1 … Θ_m. θ grows by 2π
round the loop.
"""

from math import pi

import numpy as np

from rodloop_cli.errors import SingularSystem
from rodloop_cli.numerics.condensed import CondensedSystems
from rodloop_cli.numerics.gauss import Array, GaussRule
from rodloop_cli.physics.equations import (
    FORCE,
    FX,
    FY,
    MOMENT,
    NODAL,
    NOTHING,
    POSITION,
    THETA,
    AnyArray,
    Balance,
    Fields,
    Instant,
    Load,
    Motion,
    X,
    Y,
    kinematics,
)
from rodloop_cli.physics.rod import Mesh


class BoxEquations(Balance):
    """The equations cell by cell: every cell starts from its own node, and must end where the next begins."""

    def __init__(self, mesh: Mesh, rule: GaussRule, load: Load) -> None:
        super().__init__(mesh, rule, load)
        self._integrate = rule.to_points_and_end
        self._integrate_rows = np.ascontiguousarray(self._integrate.T)
        self._length = mesh.lengths[:, None]
        self._length_by_stiffness = (mesh.lengths / mesh.stiffness)[:, None]
        self._turn = np.zeros((mesh.cells, NODAL))
        self._turn[-1, THETA] = 2 * pi

    def iterate(self, unknowns: Array, force: Array, motion: Motion) -> "BoxIterate":
        """Newton's first iterate of the stages (s, n, 6 + m); forces follow from it."""
        return BoxIterate(self, unknowns, motion)

    def angles(self, unknowns: Array) -> Array:
        """(k, n, m): a view."""
        return unknowns[..., NODAL:]

    def fields(self, unknowns: Array, motion: Motion | None) -> Fields:
        """Integrate (10)-(13) from ``unknowns`` of k instants; ``motion=None`` is statics."""
        tangent, position = self.shape(unknowns)
        velocity, acceleration = (NOTHING, NOTHING) if motion is None else kinematics(position, motion)
        force = self._integral(self._force_density(tangent, velocity, acceleration))
        force += _pair(unknowns, FORCE)
        shear = force[0, ..., :-1] * tangent[1]
        shear -= force[1, ..., :-1] * tangent[0]
        if self.load.rotary_inertia and motion is not None:
            shear += self.couple(self.angles(unknowns), motion)
        moment, theta = self.turning(unknowns, shear)
        return Fields(tangent, position, velocity, acceleration, force, moment, theta)

    def shape(self, unknowns: Array) -> tuple[Array, Array]:
        """Tangent (2, k, n, m) at the Gauss points; position (2, k, n, m + 1) there and at the right ends, by (10)."""
        tangent = self.tangent(unknowns)
        return tangent, self.position(unknowns, tangent)

    def tangent(self, unknowns: Array) -> Array:
        """(2, k, n, m) at the Gauss points."""
        theta = self.angles(unknowns)
        tangent = np.empty((2, *theta.shape))
        np.cos(theta, out=tangent[0])
        np.sin(theta, out=tangent[1])
        return tangent

    def position(self, unknowns: Array, tangent: Array) -> Array:
        """(2, k, n, m + 1) at the Gauss points and the right ends, by (10) from their tangents."""
        position = self._integral(tangent)
        position += _pair(unknowns, POSITION)
        return position

    def _force_density(self, tangent: Array, velocity: Array, acceleration: Array) -> Array:
        """(2, k, n, m): F' by (11) and (12)."""
        density = self.film(tangent, velocity[..., :-1])
        if acceleration.size:
            density += self._density * acceleration[..., :-1]
        return density

    def _start(self, unknowns: Array, component: int) -> Array:
        return unknowns[..., component, None]

    def _integral(self, values: Array) -> Array:
        integral: Array = (values * self._length) @ self._integrate
        return integral

    def residual(self, unknowns: Array, fields: Fields) -> Array:
        """(k, n, 6 + m): by how much each cell misses the next node, then the integral of M/b the angle."""
        out = np.empty_like(unknowns)
        out[..., X], out[..., Y] = fields.position[..., -1]
        out[..., FX], out[..., FY] = fields.force[..., -1]
        out[..., MOMENT] = fields.moment[..., -1]
        out[..., THETA] = fields.theta[..., -1]
        out[..., NODAL:] = fields.theta[..., :-1]
        out[..., NODAL:] -= unknowns[..., NODAL:]
        out[..., :-1, :NODAL] -= unknowns[..., 1:, :NODAL]
        out[..., -1, :NODAL] -= unknowns[..., 0, :NODAL]
        out[..., :NODAL] -= self._turn
        return out

    def displacement(self, cosine: Array, sine: Array, correction: Array) -> Array:
        """(2, n, m + 1): how far a small ``correction`` (n, 6 + m) of the unknowns moves the Gauss points and right
        ends.
        """
        turned = np.stack([-sine, cosine]) * (correction[:, NODAL:] * self._length)
        moved: Array = turned @ self._integrate + correction[:, POSITION].T[..., None]
        return moved

    def linearise(self, cosine: Array, sine: Array, force: Array, velocity: Array) -> Array:
        """(3 or 2, n, 6 + m, 6 + m): parts L0, L1[, L2] of the cells' response L0 + λ² L1 + λ L2 to their own unknowns.

        λ stands for the time derivative; L2 is there only with drag. Rows: the six values at the cell's right end,
        then the integral of M/b at the Gauss points. Arguments at one instant: cosine, sine (n, m); force, velocity
        (2, n, m).
        """
        parts, (n, m) = 3 if self.load.zeta_perp else 2, cosine.shape
        size = NODAL + m
        position = self._position_response(cosine, sine, size)
        density = np.zeros((parts, 2, n, m, size))
        angles = np.arange(m), NODAL + np.arange(m)
        density[0, 0][:, *angles] = self.load.p * cosine
        density[0, 1][:, *angles] = self.load.p * sine
        np.multiply(position[:, :, :-1], self._density[..., None], out=density[1])
        if parts == 3:
            self._add_drag_response(density, position, cosine, sine, velocity)
        density *= self._length[..., None]
        force_response = self._integrate_rows @ density
        force_response[0, 0, ..., FX] += 1
        force_response[0, 1, ..., FY] += 1
        shear = sine[..., None] * force_response[:, 0, :, :-1]
        shear -= cosine[..., None] * force_response[:, 1, :, :-1]
        shear[0][:, *angles] += force[0] * cosine + force[1] * sine
        if self.load.rotary_inertia:
            shear[1][:, *angles] += self._density * self.load.rotary_inertia
        shear *= self._length[..., None]
        moment = self._integrate_rows @ shear
        moment[0, ..., MOMENT] += 1
        turning = self._integrate_rows @ (moment[:, :, :-1] * self._length_by_stiffness[..., None])
        turning[0, ..., THETA] += 1
        response = np.zeros((parts, n, size, size))
        response[0, :, POSITION] = position[:, :, -1].swapaxes(0, 1)
        response[:, :, THETA], response[:, :, MOMENT] = turning[:, :, -1], moment[:, :, -1]
        response[:, :, FORCE] = force_response[:, :, :, -1].swapaxes(1, 2)
        response[:, :, NODAL:] = turning[:, :, :-1]
        return response

    def _position_response(self, cosine: Array, sine: Array, size: int) -> Array:
        """(2, n, m + 1, size): change of position at the Gauss points and the right end."""
        n, m = cosine.shape
        response = np.zeros((2, n, m + 1, size))
        response[0, ..., X] = response[1, ..., Y] = 1
        response[0, ..., NODAL:] = self._integrate_rows * (-sine * self._length)[:, None, :]
        response[1, ..., NODAL:] = self._integrate_rows * (cosine * self._length)[:, None, :]
        return response

    def _add_drag_response(self, density: Array, position: Array, cosine: Array, sine: Array, velocity: Array) -> None:
        """Derivative of `drag` by position (with λ, part 2) and by angle (part 0)."""
        zeta, excess = self.load.zeta_perp, self.load.zeta_perp * (self.load.gamma - 1)
        c, s = cosine[..., None], sine[..., None]
        dx, dy = position[:, :, :-1]
        along = excess * (c * dx + s * dy)
        density[2, 0] = zeta * dx + along * c
        density[2, 1] = zeta * dy + along * s
        u, v = velocity
        angles = np.arange(cosine.shape[1]), NODAL + np.arange(cosine.shape[1])
        cross, square = 2 * sine * cosine, cosine**2 - sine**2
        density[0, 0][:, *angles] += excess * (square * v - cross * u)
        density[0, 1][:, *angles] += excess * (square * u + cross * v)

    def factored(self, rates: AnyArray, cosine: Array, sine: Array, force: Array, velocity: Array) -> CondensedSystems:
        """The factored systems for time derivatives λ in ``rates`` (E,), the first of which is real (all, where they
        are of a real type); the other arguments are those of `linearise`. Raises SingularSystem.
        """
        parts = self.linearise(cosine, sine, force, velocity)
        rate = rates[:, None, None, None]
        responses = parts[0] + rate**2 * parts[1]
        if len(parts) > 2:
            responses += rate * parts[2]
        if not np.isfinite(responses.view(float)).all():
            raise SingularSystem("the linearised system is not finite")
        try:
            return CondensedSystems(responses, NODAL)
        except np.linalg.LinAlgError as error:
            raise SingularSystem("a cell's equations are singular") from error

    def load_response(self, cosine: Array, sine: Array, density: Array) -> Array:
        """(n, 6 + m): the cells' response to an extra force density (2, n, m), in the rows of `residual`."""
        force = (density * self._length) @ self._integrate
        shear = (sine * force[0, :, :-1] - cosine * force[1, :, :-1]) * self._length
        moment = shear @ self._integrate
        turning = (moment[:, :-1] * self._length_by_stiffness) @ self._integrate
        out = np.zeros((len(turning), NODAL + cosine.shape[1]))
        out[:, FORCE] = force[..., -1].T
        out[:, MOMENT], out[:, THETA], out[:, NODAL:] = moment[:, -1], turning[:, -1], turning[:, :-1]
        return out


def _pair(unknowns: Array, components: slice) -> Array:
    """(2, k, n, 1): position or force at the left nodes."""
    pair = unknowns[..., components]
    return pair.transpose(pair.ndim - 1, *range(pair.ndim - 1))[..., None]


class BoxIterate:
    """Stages of the boxes in Newton's iteration: nothing but their unknowns, and the fields that follow."""

    def __init__(self, boxes: BoxEquations, unknowns: Array, motion: Motion) -> None:
        self._boxes, self._motion = boxes, motion
        self._unknowns, self._fields = unknowns, boxes.fields(unknowns, motion)

    def instant(self, stage: int, force: Array | None) -> Instant:
        """One stage, see `Instant.of_stage`."""
        return Instant.of_stage(self._fields, stage, force)

    def residual(self, instant: Instant) -> Array:
        """(s, n, 6 + m)."""
        return self._boxes.residual(self._unknowns, self._fields)

    def correct(self, correction: Array) -> float:
        """Add a ``correction`` (s, n, 6 + m); how far it moves the rod."""
        before = self._fields.position
        self._unknowns = self._unknowns + correction
        self._fields = self._boxes.fields(self._unknowns, self._motion)
        return float(np.abs(self._fields.position - before).max())

    def solution(self) -> tuple[Array, Fields]:
        """Unknowns and fields."""
        return self._unknowns, self._fields
