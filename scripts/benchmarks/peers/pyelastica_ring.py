"""PyElastica's ring rod: a Cosserat rod of small but finite thickness, position Verlet in time.

The rod of radius a has E I = 1 and rho A = 1, hence stretching stiffness E A = 4/a^2 and rotary inertia a^2/4: it
is the inextensible rod up to O(a^2), while the stable step shrinks like a^2. ``stiffening`` multiplies the shear and
stretching stiffness beyond what the cross-section gives, which balances their error with that of rotary inertia.
An all-zero ``rest_kappa`` is taken for "not given" and silently replaced by the curvature of the initial shape; the
naturally straight rod has to be asked for by a number too small to matter.
"""

from __future__ import annotations

import elastica as ea  # type: ignore[import-not-found, unused-ignore]
import numba  # type: ignore[import-not-found, unused-ignore]
import numpy as np
from numpy.typing import NDArray

from scripts.references.pieces import Pieces
from scripts.references.problem import PI2, Problem
from scripts.references.shapes import initial_angle

from .interface import Outcome, Peer, grid_of, timed
from .nodes import observe_nodes

Array = NDArray[np.float64]

NOT_GIVEN_NO_MORE = 1e-200  # a rest curvature that is not all zero


class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing):  # type: ignore[misc, unused-ignore]
    """One rod under one load (a ring rod closes itself through the constraints)."""


def _add_load(force: Array, position: Array, velocity: Array, p: float, zeta: float, gamma: float) -> None:
    """Minus the gradient of p times the polygon's area, and drag along and across the local chord."""
    n = position.shape[1]
    for i in range(n):
        before, after = (i - 1) % n, (i + 1) % n
        dx = 0.5 * (position[0, after] - position[0, before])
        dy = 0.5 * (position[1, after] - position[1, before])
        ds = np.sqrt(dx * dx + dy * dy)
        u, v = velocity[0, i], velocity[1, i]
        along, across = gamma * zeta * (u * dx + v * dy) / ds, zeta * (v * dx - u * dy) / ds
        force[0, i] += -p * dy - (along * dx - across * dy)
        force[1, i] += p * dx - (along * dy + across * dx)


_load = numba.njit(cache=True)(_add_load)


class PressureAndDrag(ea.NoForces):  # type: ignore[misc, unused-ignore]
    def __init__(self, p: float, zeta: float, gamma: float) -> None:
        super().__init__()
        self.load = (float(p), float(zeta), float(gamma))

    def apply_forces(self, system: ea.CosseratRod, time: float = 0.0) -> None:
        _load(system.external_forces, system.position_collection, system.velocity_collection, *self.load)


def make_rod(problem: Problem, elements: int, radius: float, stiffening: float) -> ea.CosseratRod:
    """Nodes on the initial curve at equal arclength, stiffness by element, its compliance averaged at the nodes."""
    s = PI2 * np.arange(elements) / elements
    x, y = _curve(problem, s)
    chord = np.vstack([np.roll(x, -1) - x, np.roll(y, -1) - y, 0 * x])
    tangent = chord / np.linalg.norm(chord, axis=0)
    up = np.array([0.0, 0.0, 1.0])
    directors = np.stack([np.tile(up[:, None], elements), np.cross(tangent.T, up).T, tangent])
    middle = np.searchsorted(problem.edges, s + PI2 / (2 * elements)) - 1
    stiffness = np.array([p.stiffness for p in problem.segments])[middle]
    density = np.array([p.density for p in problem.segments])[middle]
    if np.ptp(density) > 0:
        raise ValueError("uneven density is not set up for PyElastica")
    rod = ea.CosseratRod.ring_rod(
        elements, np.zeros(3), np.array([1.0, 0, 0]), up, PI2, radius, 1 / (np.pi * radius**2),
        youngs_modulus=4 / (np.pi * radius**4), position=np.vstack([x, y, 0 * x]), directors=directors,
        rest_kappa=np.full((3, elements), NOT_GIVEN_NO_MORE),
    )  # fmt: skip
    rod.shear_matrix[:] *= stiffening
    rod.bend_matrix[:] *= 2 / (1 / stiffness + 1 / np.roll(stiffness, -1))
    return rod


def _curve(problem: Problem, s: Array) -> tuple[Array, Array]:
    pieces = Pieces.between(np.append(s, PI2), 8)
    angle = initial_angle(problem)(pieces.points)
    at_nodes = np.searchsorted(pieces.breaks, s - 1e-9)
    return pieces.integrate(np.cos(angle))[1][at_nodes], pieces.integrate(np.sin(angle))[1][at_nodes]


def stable_step(elements: int, radius: float, stiffening: float, stiffest: float) -> float:
    """2/omega of the fastest of bending, stretching (4/(a ds)) and shear with rotation (2.27/a^2, 8 sqrt(b)/(a ds))."""
    ds = PI2 / elements
    shear = stiffening * (27 / 28) * (16 / 3) / radius**4 + 64 * stiffest / (ds * radius) ** 2
    return 2 / float(max(4 * np.sqrt(stiffest) / ds**2, 4 * np.sqrt(stiffening) / (radius * ds), np.sqrt(shear)))


def solve(problem: Problem, elements: int, radius: float, stiffening: float = 1.0,
          courant: float = 0.9) -> Outcome:  # fmt: skip
    """Steps of about ``courant`` times the stable one, a whole number of them to every stated time."""
    warm_up = _prepare(problem, elements, radius, stiffening)
    ea.PositionVerlet().step(warm_up[0], 0.0, 1e-9)  # compiles
    with timed() as clock:
        simulator, rod = _prepare(problem, elements, radius, stiffening)
        stepper = ea.PositionVerlet()
        limit = courant * stable_step(elements, radius, stiffening, max(s.stiffness for s in problem.segments))
        t, stretch, states = np.float64(0.0), 0.0, [_state(rod)]
        for left, right in zip(problem.times[:-1], problem.times[1:], strict=True):
            steps = int(np.ceil((right - left) / limit))
            for _ in range(steps):
                t = stepper.step(simulator, t, (right - left) / steps)
            states.append(_state(rod))
            stretch = max(stretch, float(np.abs(rod.dilatation - 1).max()))
    rows = observe_nodes(problem, states)
    return Outcome(clock.seconds, rows, f"largest stretch {stretch:.1e}")


def _prepare(problem: Problem, elements: int, radius: float, stiffening: float) -> tuple[Simulator, ea.CosseratRod]:
    simulator, rod = Simulator(), make_rod(problem, elements, radius, stiffening)
    simulator.append(rod)
    simulator.add_forcing_to(rod).using(PressureAndDrag, problem.p, problem.zeta_perp, problem.gamma)
    simulator.finalize()
    return simulator, rod


def _state(rod: ea.CosseratRod) -> tuple[Array, Array]:
    return rod.position_collection[:2].copy(), rod.velocity_collection[:2].copy()


THIN = [0.1, 0.05, 0.03]
PEER = Peer(
    "PyElastica ring rod",
    solve,
    {
        "H": grid_of(elements=[48], radius=THIN, stiffening=[1.0, 4.0])
        + grid_of(elements=[96, 144], radius=[0.03, 0.02], stiffening=[4.0]),
        "S": grid_of(elements=[48], radius=THIN, stiffening=[1.0, 4.0])
        + grid_of(elements=[96, 192], radius=[0.03, 0.02], stiffening=[4.0]),
        "D": grid_of(elements=[48, 96], radius=[0.05, 0.03], stiffening=[4.0]),
        "P64": grid_of(elements=[96, 192], radius=[0.05, 0.025], stiffening=[4.0]),
    },
    "stretching, shear and rotary inertia O(a^2) of the finite thickness, then second-order differences in space",
)
