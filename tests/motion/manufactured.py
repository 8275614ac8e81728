"""A motion that is known exactly, and made a solution of the balance laws by an extra force and moment along the rod.

Four equal segments, stiffness 1, 3, 1, 3 and density 1, 2, 1, 2. The moment is prescribed, smooth across the junctions,

    M(s, t) = c(t) + A(t) cos 2s + B(t) sin 2s,        θ(s, t) = φ(t) + ∫ M/b ds,

so that θ' jumps there. M/b has the period π and c makes θ grow by 2π: the second half of the loop is the first one,
turned by π, and the loop is closed. It is inextensible, for x' = cos θ and y' = sin θ are integrated to round-off, as
velocity and acceleration are. The internal force F(s, t) is any smooth field. What does not balance then in (11)-(13)
is made up for by a force density f and a moment density g. Vectors are complex numbers here, x + iy.
"""

from itertools import pairwise
from math import pi

import numpy as np

from rodloop_cli.march.state import State
from rodloop_cli.numerics.gauss import gauss_rule
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.closure import Closure
from rodloop_cli.physics.equations import FORCE, MOMENT, NODAL, THETA, Load
from rodloop_cli.physics.rod import Mesh, Rod, Segment
from rodloop_cli.physics.whole_loop import LoopEquations

STIFFNESS = (1.0, 3.0, 1.0, 3.0)
ROD = Rod(tuple(Segment(0.25, b, rho) for b, rho in zip(STIFFNESS, (1.0, 2.0, 1.0, 2.0), strict=True)))
LOAD = Load(p=2.5, zeta_perp=0.8, gamma=0.3, rotary_inertia=0.05)

AMPLITUDES = np.array([0.08, 0.1, 0.12, 0.04, -0.06])
RATES = np.array([5.2, 7.6, 6.4, 4.4, 6.8])
FINE = gauss_rule(12)


def swings(t, derivative=0):
    """(5, k): φ, A, B and the place of s = 0, or their time derivatives, at times (k,).

    They go as sin³: the loop starts at rest, without acceleration, as an arc of a circle in every segment. That shape
    is one of the motion of the boxes too; from another start they would be set ringing by what they cannot resolve.
    """
    phase, turned = np.multiply.outer(RATES, t), derivative * pi / 2
    cubes = 3 * np.sin(phase + turned) - 3**derivative * np.sin(3 * phase + turned)
    return (AMPLITUDES * RATES**derivative)[:, None] * cubes / 4


def coefficients(t, derivative=0):
    """(4, k): φ, c, A, B."""
    turn, a, b = swings(t, derivative)[:3]
    growth = 2 * pi * (derivative == 0) - 2 * b * (1 / STIFFNESS[0] - 1 / STIFFNESS[1])
    return np.stack([turn, growth / (pi / 2 * sum(1 / b for b in STIFFNESS)), a, b])


def angle(s, t, derivative=0):
    """(k, ...): θ, θ_t or θ_tt at places (...) and times (k,)."""
    pieces = pairwise(np.linspace(0, 2 * pi, 5))
    inside = sum(
        (_antiderivatives(np.clip(s, start, end)) - _antiderivatives(np.full_like(s, start))) / b
        for (start, end), b in zip(pieces, STIFFNESS, strict=True)
    )
    return np.tensordot(coefficients(t, derivative).T, np.concatenate([np.ones((1, *s.shape)), inside]), 1)


def _antiderivatives(s):
    return np.stack([s, np.sin(2 * s) / 2, -np.cos(2 * s) / 2])


def moment(s, t, derivative=0):
    """(k, ...): M, or M' for derivative = 1."""
    wave = 2**derivative * np.stack([np.cos(2 * s + derivative * pi / 2), np.sin(2 * s + derivative * pi / 2)])
    return np.tensordot(coefficients(t)[1:].T, np.concatenate([np.full((1, *s.shape), 1.0 - derivative), wave]), 1)


def force(s, t, derivative=0):
    """(k, ...): F, or F' for derivative = 1."""
    first, second = 0.9 * 1j**derivative, 0.5 * (-2j) ** derivative
    turning = np.exp(1j * t).reshape(-1, *[1] * s.ndim)
    return (0.4 - 0.2j) * (1 - derivative) + first * np.exp(1j * s) * turning + second * np.exp(-2j * s) * turning


class Exact:
    """Position, velocity and acceleration (k, n, j) in the cells of a mesh, at places (j,) of the unit cell of which
    the last one is 1, and at times (k,).
    """

    def __init__(self, mesh, places, t):
        self._mesh, self._places, self._t = mesh, places, t
        s = mesh.points(np.multiply.outer(places, FINE.points).ravel()).reshape(mesh.cells, len(places), -1)
        spin, spin_rate = angle(s, t, 1), angle(s, t, 2)
        tangent = np.exp(1j * angle(s, t))
        self.position = self._integral(tangent, 0)
        self.velocity = self._integral(1j * spin * tangent, 1)
        self.acceleration = self._integral((1j * spin_rate - spin**2) * tangent, 2)

    def _integral(self, slope, derivative):
        inside = slope @ FINE.weights * self._places * self._mesh.lengths[:, None]
        x, y = swings(self._t, derivative)[3:, :, None, None]
        return inside + (np.cumsum(inside[..., -1], axis=-1) - inside[..., -1])[..., None] + (x + 1j * y)


class Forced:
    """The balance laws with f and g, whichever way they are solved."""

    times = np.zeros(1)
    """(k,): of the stages; to be set on this class before every step."""
    _made_for = None

    def film(self, tangent, velocity):
        return super().film(tangent, velocity) + as_pair(self._sources()[0]).reshape(tangent.shape)

    def couple(self, angles, motion):
        return super().couple(angles, motion) + self._sources()[1]

    def _sources(self):
        if self._made_for is not Forced.times:
            self._made_for, self._made = Forced.times, sources(self.mesh, self.rule.points, Forced.times)
        return self._made


class ForcedBoxes(Forced, BoxEquations):
    pass


class ForcedLoop(Forced, LoopEquations):
    pass


def sources(mesh, points, t):
    """f and g (k, n, m) at the Gauss points."""
    s, rho, places = mesh.points(points), mesh.density[:, None], np.append(points, 1.0)
    exact, tangent = Exact(mesh, places, t), np.exp(1j * angle(s, t))
    velocity = exact.velocity[..., :-1]
    drag = LOAD.zeta_perp * (velocity + (LOAD.gamma - 1) * (velocity * tangent.conj()).real * tangent)
    pressure = -1j * LOAD.p * tangent
    f = force(s, t, 1) - pressure - drag - rho * exact.acceleration[..., :-1]
    shear = (force(s, t) * tangent.conj()).imag
    return f, moment(s, t, 1) + shear - rho * LOAD.rotary_inertia * angle(s, t, 2)


def state_at(time, cells, m):
    """The exact motion on ``cells`` cells a segment with m Gauss points, its positions integrated and closed as runs
    do it.
    """
    mesh, rule, t = Mesh.on(ROD, (cells,) * len(ROD.segments)), gauss_rule(m), np.array([time])
    equations, closure = ForcedBoxes(mesh, rule, LOAD), Closure(BoxEquations(mesh, rule, LOAD))
    places = np.append(rule.points, 1.0)
    exact, nodes = Exact(mesh, places, t), mesh.edges[:-1]
    unknowns, rates = np.zeros((2, mesh.cells, NODAL + m))
    for values, derivative in ((unknowns, 0), (rates, 1)):
        values[:, THETA], values[:, NODAL:] = (angle(s, t, derivative)[0] for s in (nodes, mesh.points(rule.points)))
    unknowns[:, MOMENT] = moment(nodes, t)[0]
    unknowns[:, FORCE] = as_pair(force(nodes, t)[0]).T
    position = closure.position(unknowns, closure.centre(as_pair(exact.position[0])))
    velocity = closure.velocity(unknowns, rates, closure.centre(as_pair(exact.velocity[0])))
    acceleration, tension = as_pair(exact.acceleration[0]), as_pair(force(mesh.points(places), t)[0])
    return State(time, equations, unknowns, rates, position, velocity, acceleration, tension)


def errors(state):
    """The largest error at the nodes of each of the values that a state holds."""
    mesh, t = state.equations.mesh, np.array([state.time])
    exact, nodes, ends = Exact(mesh, np.ones(1), t), mesh.edges[:-1], mesh.edges[1:, None]
    differences = {
        "position": as_pair(exact.position[0]) - state.position[..., -1:],
        "angle": angle(nodes, t)[0] - state.unknowns[:, THETA],
        "velocity": as_pair(exact.velocity[0]) - state.velocity[..., -1:],
        "acceleration": as_pair(exact.acceleration[0]) - state.acceleration[..., -1:],
        "moment": moment(nodes, t)[0] - state.unknowns[:, MOMENT],
        "force": as_pair(force(ends, t)[0]) - state.force[..., -1:],
    }
    return {name: float(np.abs(difference).max()) for name, difference in differences.items()}


def as_pair(vector):
    """(2, ...): the two components."""
    return np.stack([vector.real, vector.imag])
