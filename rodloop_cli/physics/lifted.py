"""Newton's iteration round the whole loop, lifted [Albersmeyer & Diehl, SIAM J. Optim. 20 (2010) 1655].

The forces at all points keep the values that the linearised equations gave them. Forces integrated from the
accelerations of an iterate contain its error times Δt⁻², which the product with the tangent, (13), would spread over
the whole loop.

A step takes a few of these iterations and little else, and on few points the number of array operations is what they
cost. So each integral is one product: its arguments stand side by side in one array, see `LoopIntegrals`.
"""

import numpy as np

from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import (
    FORCE,
    FX,
    FY,
    MOMENT,
    NODAL,
    NOTHING,
    POSITION,
    THETA,
    Fields,
    Instant,
    Motion,
    X,
    Y,
    kinematics,
)
from rodloop_cli.physics.loop_integrals import LoopIntegrals


class LoopIterate:
    """The s stages of a step: the loop's unknowns, and forces of their own.

    Places are in the order of Gauss points first, see `loop_integrals`.
    """

    def __init__(self, loop: LoopIntegrals, unknowns: Array, force: Array, motion: Motion) -> None:
        self._loop, self._motion = loop, motion
        self._stages, self._points = stages, points = len(unknowns), loop.points
        self._twice = motion.rates @ motion.rates
        self._past = motion.rates @ self._at_points(motion.velocity_past)
        self._past += self._at_points(motion.acceleration_past)
        self._force = self._at_points(force)
        self._arguments = np.empty((stages, loop.size + points + 1))
        self._unknowns, self._shear = self._arguments[:, : loop.size], self._arguments[:, loop.size : -1]
        self._arguments[:, -1] = 1.0
        self._unknowns[:, :NODAL] = unknowns[:, 0, :NODAL]
        self._unknowns[:, NODAL:] = unknowns[..., NODAL:].reshape(stages, points)
        self._slopes = np.empty((2, stages, points + 1))
        self._tangent, self._normal = self._slopes[..., :-1], np.empty((2, stages, points))
        self._densities = np.empty((2, stages, 2 * points + 1))
        self._instant: Instant | None = None
        self._reshape()

    def _at_points(self, values: Array) -> Array:
        """(2, s, N) from values by cells (2, s, n, m + 1)."""
        return values[..., :-1].reshape(2, self._stages, self._points)

    def _reshape(self) -> None:
        """Tangents, normals and positions of the unknowns."""
        angles = self._unknowns[:, NODAL:]
        np.cos(angles, out=self._tangent[0])
        np.sin(angles, out=self._tangent[1])
        self._normal[0] = self._tangent[1]
        np.negative(self._tangent[0], out=self._normal[1])
        self._slopes[..., -1] = self._unknowns[:, POSITION].T
        self._position = _product(self._slopes, self._loop.to_position)

    def instant(self, stage: int, force: Array | None) -> Instant:
        """One stage, see `Instant.of_stage`."""
        cells = (self._loop.mesh.cells, -1)
        velocity = self._motion.rates[stage] @ self._position[..., : self._points]
        velocity = velocity.reshape(2, *cells) + self._motion.velocity_past[:, stage, :, :-1]
        chosen = self._force[:, stage].reshape(2, *cells) if force is None else force[..., :-1]
        # A copy: the iterate goes on, and turns its tangents where they stand.
        cosine, sine = self._tangent[:, stage].copy().reshape(2, *cells)
        return Instant(cosine, sine, chosen, velocity)

    def _freeze(self, instant: Instant) -> None:
        """What the linearised equations need of the instant they are linearised at."""
        if instant is self._instant:
            return
        self._instant, cosine, sine = instant, instant.cosine.ravel(), instant.sine.ravel()
        self._frozen_tangent, self._frozen_normal = np.array([[[cosine], [sine]], [[sine], [-cosine]]])
        self._frozen_pressure = self._frozen_tangent * self._loop.load.p
        self._frozen_force = instant.force.reshape(2, 1, -1)

    def residual(self, instant: Instant) -> Array:
        """(s, 6 + N): by how much the loop fails to close, then the integral of M/b the angle.

        By how much the forces miss their own balance acts on the tangent of ``instant``.
        """
        self._freeze(instant)
        force = self._integrated = self._balanced_force()
        shear = self._force * self._normal
        missing = force[..., : self._points] - self._force
        missing *= self._frozen_normal
        shear += missing
        np.add(shear[0], shear[1], out=self._shear)
        if self._loop.load.rotary_inertia:
            couple = self._loop.couple(self._loop.angles(self._unknowns), self._motion)
            self._shear += couple.reshape(self._shear.shape)
        out: Array = self._arguments @ self._loop.to_residual
        np.subtract(self._position[..., -1].T, self._unknowns[:, POSITION], out=out[:, POSITION])
        np.subtract(force[..., -1].T, self._unknowns[:, FORCE], out=out[:, FORCE])
        return out

    def _balanced_force(self) -> Array:
        """(2, s, P): the forces that (11) and (12) give."""
        points, loop = self._points, self._loop
        inside = self._position[..., :points]
        acceleration = self._densities[..., :points]
        np.matmul(self._twice, inside, out=acceleration)
        acceleration += self._past
        velocity = NOTHING
        if loop.load.zeta_perp:
            velocity = self._motion.rates @ inside
            velocity += self._at_points(self._motion.velocity_past)
        self._densities[..., points:-1] = loop.film(self._tangent, velocity)
        self._densities[..., -1] = self._unknowns[:, FORCE].T
        return _product(self._densities, loop.to_force)

    def correct(self, correction: Array) -> float:
        """Add a ``correction`` (s, 6 + N), and to the forces their linear response; how far it moves the rod."""
        turned = np.empty_like(self._slopes)
        np.multiply(self._frozen_normal, -correction[:, NODAL:], out=turned[..., :-1])
        turned[..., -1] = correction[:, POSITION].T
        moved = _product(turned, self._loop.to_position)
        self._correction, self._response = correction, self._force_response(correction, moved)
        self._integrated += self._response
        self._force = self._integrated[..., : self._points]
        self._unknowns += correction
        before = self._position
        self._reshape()
        return float(np.abs(self._position - before).max())

    def _force_response(self, correction: Array, moved: Array) -> Array:
        """(2, s, P): change of the forces when the loop turns by ``correction`` and is ``moved`` (2, s, P); but for the
        drag's change with the direction of the rod, which the next residual brings.
        """
        points, load = self._points, self._loop.load
        inside = moved[..., :points]
        densities = np.empty_like(self._densities)
        np.matmul(self._twice, inside, out=densities[..., :points])
        np.multiply(self._frozen_pressure, correction[:, NODAL:], out=densities[..., points:-1])
        if load.zeta_perp:
            densities[..., points:-1] += self._loop.drag(self._frozen_tangent, self._motion.rates @ inside)
        densities[..., -1] = correction[:, FORCE].T
        return _product(densities, self._loop.to_force)

    def solution(self) -> tuple[Array, Fields]:
        """The unknowns of the boxes (s, n, 6 + m) and the fields, by cells."""
        loop, by_cells = self._loop, self._loop.by_cells
        self._add_response_of_shear()
        shape = (self._stages, loop.mesh.cells, -1)
        moment, theta = loop.turning(self._unknowns, self._shear.reshape(shape))
        position = self._position.take(by_cells, axis=-1)
        velocity, acceleration = kinematics(position, self._motion)
        force = self._integrated.take(by_cells, axis=-1)
        fields = Fields(self._tangent.reshape(2, *shape), position, velocity, acceleration, force, moment, theta)
        return self._by_boxes(fields), fields

    def _add_response_of_shear(self) -> None:
        """Moments and angles, too, respond to the last correction linearly."""
        shear = self._response[..., : self._points] * self._frozen_normal
        along = self._frozen_force * self._frozen_tangent
        shear += along * self._correction[:, NODAL:]
        self._shear += shear[0]
        self._shear += shear[1]
        if self._loop.load.rotary_inertia:
            response = self._loop.couple_response(self._loop.angles(self._correction), self._motion.rates)
            self._shear += response.reshape(self._shear.shape)

    def _by_boxes(self, fields: Fields) -> Array:
        out = np.empty((self._stages, self._loop.mesh.cells, NODAL + self._loop.rule.m))
        out[:, 0, :NODAL] = self._unknowns[:, :NODAL]
        out[:, 1:, X], out[:, 1:, Y] = fields.position[..., :-1, -1]
        out[:, 1:, THETA], out[:, 1:, MOMENT] = fields.theta[:, :-1, -1], fields.moment[:, :-1, -1]
        out[:, 1:, FX], out[:, 1:, FY] = fields.force[..., :-1, -1]
        out[..., NODAL:] = self._loop.angles(self._unknowns)
        return out


def _product(arguments: Array, matrix: Array) -> Array:
    """(2, s, P) from (2, s, K): one product for both components."""
    product: Array = arguments.reshape(-1, len(matrix)) @ matrix
    return product.reshape(2, -1, matrix.shape[1])
