"""The balance laws of the loop, Eqs. (10)-(13), and their integrals along a mesh.

    x' = cos θ,  y' = sin θ                                                                         (10)
    Fx' =  p sin θ + ζ⊥[(γ cos²θ + sin²θ) u + (γ-1) sinθ cosθ v] + ρ a_x                             (11)
    Fy' = -p cos θ + ζ⊥[(γ-1) sinθ cosθ u + (γ sin²θ + cos²θ) v] + ρ a_y                             (12)
    M'  = Fx sin θ - Fy cos θ + ρ ι θ_tt,   θ' = M/b                                                (13), and (1) for ι

Prime is d/ds; (u, v) velocity, (a_x, a_y) acceleration; b = B/B1, ρ = ρ/ρ1, ι the rotary inertia I/(A R²), zero in
the paper. Once the angles at the Gauss points are known, position, force and moment follow by integration; `boxes`
does it cell by cell, `whole_loop` round the loop.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.numerics.gauss import Array, GaussRule
from rodloop_cli.physics.rod import Mesh

AnyArray = NDArray[Any]

X, Y, THETA, MOMENT, FX, FY = range(6)
NODAL = 6
POSITION, FORCE = slice(X, Y + 1), slice(FX, FY + 1)


@dataclass(frozen=True)
class Load:
    """What the film does to the rod: p R³/B1, normal drag ζ⊥, anisotropy γ = ζ∥/ζ⊥; and the rod's rotary inertia ι."""

    p: float
    zeta_perp: float = 0.0
    gamma: float = 0.5
    rotary_inertia: float = 0.0


class Motion(NamedTuple):
    """How velocity and acceleration follow from the unknowns at the stages: U = R X + u, W = R U + w.

    rates: (k, k);  velocity_past: (2, k, n, m + 1) u;  acceleration_past: (2, k, n, m + 1) w;
    spin_past, spin_rate_past: (k, n, m) the same for the angles, needed with rotary inertia alone.
    """

    rates: Array
    velocity_past: Array
    acceleration_past: Array
    spin_past: Array | None = None
    spin_rate_past: Array | None = None


class Fields(NamedTuple):
    """What follows from the unknowns at k stages, at the Gauss points and, last, at the right end of each cell.

    tangent: (2, k, n, m) at the Gauss points alone;  position, velocity, acceleration, force: (2, k, n, m + 1);
    moment, theta: (k, n, m + 1).  Velocity and acceleration are empty in statics.
    """

    tangent: Array
    position: Array
    velocity: Array
    acceleration: Array
    force: Array
    moment: Array
    theta: Array

    @property
    def cosine(self) -> Array:
        """(k, n, m)."""
        cosine: Array = self.tangent[0]
        return cosine

    @property
    def sine(self) -> Array:
        """(k, n, m)."""
        sine: Array = self.tangent[1]
        return sine


class Instant(NamedTuple):
    """Where the equations are linearised: cosine, sine (n, m); force, velocity (2, n, m)."""

    cosine: Array
    sine: Array
    force: Array
    velocity: Array

    @classmethod
    def of_stage(cls, fields: Fields, stage: int, force: Array | None = None) -> Self:
        """The instant of one stage; ``force`` (2, n, m + 1) where the stage's own is not to be trusted yet."""
        chosen = fields.force[:, stage] if force is None else force
        cosine, sine = fields.tangent[:, stage]
        return cls(cosine, sine, chosen[..., :-1], fields.velocity[:, stage, :, :-1])


class Iterate(Protocol):
    """All stages of a step, while Newton's iteration works on them.

    An iteration is `residual`, then `correct`; after the last one comes `solution`, once. Both refer to the instant of
    the last `residual`.
    """

    def instant(self, stage: int, force: Array | None) -> Instant:
        """One of them, see `Instant.of_stage`."""

    def residual(self, instant: Instant) -> Array:
        """(s, …): by how much they miss the equations, with ``instant`` where these are linearised."""

    def correct(self, correction: Array) -> float:
        """Add a ``correction`` (s, …); how far it moves the rod."""

    def solution(self) -> tuple[Array, Fields]:
        """The unknowns of the boxes (s, n, 6 + m) and the fields, after a last correction."""


NOTHING = np.zeros(0)


class Balance(ABC):
    """What the two ways to integrate (10)-(13) along a mesh have in common: the film, the couple, and (13).

    What is unknown, where the integrals start, and what is left to solve, `boxes` and `whole_loop` say.
    """

    def __init__(self, mesh: Mesh, rule: GaussRule, load: Load) -> None:
        self.mesh, self.rule, self.load = mesh, rule, load
        self._density = mesh.density[:, None]
        self._compliance = 1 / mesh.stiffness[:, None]

    @abstractmethod
    def angles(self, unknowns: Array) -> Array:
        """(k, n, m): the angles at the Gauss points."""

    @abstractmethod
    def _start(self, unknowns: Array, component: int) -> Array:
        """(k, cells, 1): the nodal values from which the integrals start."""

    @abstractmethod
    def _integral(self, values: Array) -> Array:
        """(..., n, m + 1): integrals of ``values`` (..., n, m) up to the Gauss points and the right ends."""

    def couple(self, angles: Array, motion: Motion) -> Array:
        """ρ ι θ_tt (k, n, m), which (13) adds to the shear."""
        couple: Array = self._density * self.load.rotary_inertia * _spin_rate(angles, motion)
        return couple

    def couple_response(self, correction: Array, rates: Array) -> Array:
        """(k, n, m): change of the `couple` by a ``correction`` (k, n, m) of the angles; ``rates`` as in `Motion`."""
        flat = (len(rates), -1)
        spin_rate = (rates @ (rates @ correction.reshape(flat))).reshape(correction.shape)
        response: Array = self._density * self.load.rotary_inertia * spin_rate
        return response

    def turning(self, unknowns: Array, shear: Array) -> tuple[Array, Array]:
        """Moment and angle (k, n, m + 1) by (13), from the shear Fx sin θ - Fy cos θ (k, n, m) and the couple."""
        moment = self._integral(shear)
        moment += self._start(unknowns, MOMENT)
        theta = self._integral(moment[..., :-1] * self._compliance)
        theta += self._start(unknowns, THETA)
        return moment, theta

    def film(self, tangent: Array, velocity: Array) -> Array:
        """Pressure and drag per length, of the shape of ``tangent`` (2, …); no drag where ``velocity`` is empty.

        The drag is ζ⊥ (u + (γ - 1)(u·t) t): (11) and (12) in vector form.
        """
        film = np.empty_like(tangent)
        np.multiply(tangent[1], self.load.p, out=film[0])
        np.multiply(tangent[0], -self.load.p, out=film[1])
        if velocity.size and self.load.zeta_perp:
            film += self.drag(tangent, velocity)
        return film

    def drag(self, tangent: Array, velocity: Array) -> Array:
        """The drag alone, see `film`."""
        along = (tangent * velocity).sum(axis=0)
        along *= self.load.gamma - 1
        drag: Array = (velocity + along * tangent) * self.load.zeta_perp
        return drag


def _spin_rate(theta: Array, motion: Motion) -> Array:
    """θ_tt (k, n, m)."""
    assert motion.spin_past is not None
    assert motion.spin_rate_past is not None
    flat = (len(motion.rates), -1)
    spin = (motion.rates @ theta.reshape(flat)).reshape(theta.shape) + motion.spin_past
    rate: Array = (motion.rates @ spin.reshape(flat)).reshape(theta.shape) + motion.spin_rate_past
    return rate


def kinematics(position: Array, motion: Motion) -> tuple[Array, Array]:
    """Velocity and acceleration (2, k, n, m + 1)."""
    shape = (2, len(motion.rates), -1)
    velocity = (motion.rates @ position.reshape(shape)).reshape(position.shape)
    velocity += motion.velocity_past
    acceleration = (motion.rates @ velocity.reshape(shape)).reshape(position.shape)
    acceleration += motion.acceleration_past
    return velocity, acceleration
