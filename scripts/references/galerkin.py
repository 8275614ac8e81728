"""Lagrange's equations in the tangent angle alone, with piecewise polynomials: the reference for loops with junctions.

The only field is theta(s) = s + psi(s, t); psi is continuous and a polynomial of degree n on each element. Positions
r(s) = r(0) + int_0^s t and velocities v(s) = v(0) + int_0^s theta_t n are integrals of it, so that inextensibility is
exact. For every virtual rotation phi_j and translation, with dr = dr(0) + int_0^s phi_j n,

    int rho a.dr ds = - int b theta' phi_j' ds + p int n.dr ds - zeta int (gamma v_t t + v_n n).dr ds
                      + lambda.int phi_j n ds
    a = a(0) + int_0^s (theta_tt n - theta_t^2 t),     0 = int (theta_tt n - theta_t^2 t) ds    (closure)

Continuity of the moment and of the shear force at a junction are natural conditions: they need no grid point of a
particular kind, and there are neither forces nor moments among the unknowns. The mass matrix is dense.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.linalg import block_diag, lapack

from .pieces import primitives
from .problem import Problem

Array = NDArray[np.float64]

EXTRA_POINTS = 4  # quadrature points beyond the degree: cos(theta) is not a polynomial


@dataclass(frozen=True)
class Basis:
    """E elements of degree n with q Gauss points each: N = E n free values psi_j at shared Lobatto points, Q = E q."""

    free_points: Array  # [N] arclength
    points: Array  # [Q] arclength
    half: Array  # [E] half lengths
    value: Array  # [q, n + 1] local values at the Gauss points
    running: Array  # [q + 1, q] int_-1^x of values at the Gauss points; last row up to 1
    slope: Array  # [Q, N]
    weight: Array  # [Q]
    stiffness: Array  # [Q] b
    density: Array  # [Q] rho
    root_inertia: Array  # [2 Q] sqrt(rho * weight), for both directions
    quarters: Array  # [4, Q] int_0^s up to s = 0, pi/2, pi, 3 pi/2
    at_start: Array  # [N] slope at s = 0+

    @property
    def count(self) -> int:
        return len(self.half)


@dataclass(frozen=True)
class State:
    """Unpacked state of one moment."""

    psi: Array  # [N]
    omega: Array  # [N] psi_t
    v0: Array  # [2] velocity of the point s = 0
    dissipated: float


def make_basis(problem: Problem, degree: int, per_segment: int = 1) -> Basis:
    """Elements of equal length in each segment, polynomials of the given degree."""
    lobatto = np.r_[-1.0, np.sort(legendre.Legendre.basis(degree).deriv().roots().real), 1.0]
    gauss, w = legendre.leggauss(degree + EXTRA_POINTS)
    to_modes = np.linalg.inv(legendre.legvander(lobatto, degree))
    ends, bs, rhos = _elements(problem, per_segment)
    half, middle = np.diff(ends) / 2, (ends[:-1] + ends[1:]) / 2
    slope = _slopes(gauss, degree) @ to_modes
    at_start = _slopes(np.array([-1.0]), degree) @ to_modes / half[0]
    weight = np.outer(half, w).ravel()
    density = np.repeat(rhos, len(gauss))
    return Basis(
        free_points=(middle[:, None] + np.outer(half, lobatto[:-1])).ravel(),
        points=(middle[:, None] + np.outer(half, gauss)).ravel(),
        half=half,
        value=legendre.legvander(gauss, degree) @ to_modes,
        running=primitives(np.r_[gauss, 1.0], gauss, w),
        slope=_share(block_diag(*[slope / h for h in half]), degree),
        weight=weight,
        stiffness=np.repeat(bs, len(gauss)),
        density=density,
        root_inertia=np.tile(np.sqrt(density * weight), 2),
        quarters=_integrals(np.linspace(0, 3 * np.pi / 2, 4), ends, gauss, w),
        at_start=_share(np.pad(at_start, ((0, 0), (0, (len(half) - 1) * (degree + 1)))), degree)[0],
    )


def _elements(problem: Problem, per_segment: int) -> tuple[Array, Array, Array]:
    edges = problem.edges
    inner = [np.linspace(a, b, per_segment + 1)[:-1] for a, b in pairwise(edges)]
    ends = np.append(np.concatenate(inner), edges[-1])
    bs = np.repeat([s.stiffness for s in problem.segments], per_segment)
    rhos = np.repeat([s.density for s in problem.segments], per_segment)
    return ends, bs, rhos


def _share(columns: Array, degree: int) -> Array:
    """Add the column of each element's last value to that of the next one's first: [.., E (n + 1)] to [.., E n]."""
    split = columns.reshape(*columns.shape[:-1], -1, degree + 1)
    shared = split[..., :degree].copy()
    shared[..., 0] += np.roll(split[..., degree], 1, axis=-1)
    return shared.reshape(*columns.shape[:-1], -1)


def _slopes(x: Array, degree: int) -> Array:
    """P_k'(x), [points, degree + 1]."""
    return np.column_stack([legendre.Legendre.basis(k).deriv()(x) for k in range(degree + 1)])


def _integrals(s: Array, ends: Array, gauss: Array, w: Array) -> Array:
    """Rows that integrate from 0 to each s, [s, Q]."""
    rows = []
    for left, right in pairwise(ends):
        x = np.clip((2 * s - left - right) / (right - left), -1.0, 1.0)
        rows.append((right - left) / 2 * primitives(x, gauss, w))
    return np.hstack(rows)


def pack(state: State) -> Array:
    return np.concatenate([state.psi, state.omega, state.v0, [state.dissipated]])


def unpack(y: Array) -> State:
    n = (len(y) - 3) // 2
    return State(y[:n], y[n : 2 * n], y[2 * n : 2 * n + 2], float(y[-1]))


def at_points(free: Array, basis: Basis) -> Array:
    """Values at the Gauss points, [Q], of a field given by its free values."""
    n = basis.value.shape[1] - 1
    local = np.empty((basis.count, n + 1))
    local[:, :n] = free.reshape(-1, n)
    local[:, n] = np.roll(local[:, 0], -1)
    return (local @ basis.value.T).ravel()


def integrate(values: Array, basis: Basis) -> Array:
    """int_0^s of each row of ``values`` [.., Q] at the Gauss points."""
    local = values.reshape(*values.shape[:-1], basis.count, -1) @ basis.running.T * basis.half[:, None]
    local[..., 1:, :-1] += np.cumsum(local[..., :-1, -1:], axis=-2)
    return local[..., :-1].reshape(values.shape)


def turning(c: Array, s: Array, basis: Basis) -> tuple[Array, Array]:
    """Derivative of the positions [2 Q, N + 2], and of the gap of the loop [2, N], by psi_j and r(0)."""
    count, q, n = basis.count, basis.value.shape[0], basis.value.shape[1] - 1
    normal = np.stack([-s, c]).reshape(2, count, q, 1) * basis.half[:, None, None]
    local = basis.running @ (normal * basis.value)
    full = np.zeros((2, count, q, count, n + 1))
    for e in range(count):
        full[:, e, :, e] = local[:, e, :-1]
        full[:, e + 1 :, :, e] = local[:, e, -1][:, None, None]
    out = np.zeros((2, count * q, count * n + 2))
    out[:, :, :-2] = _share(full.reshape(2, count * q, -1), n)
    out[0, :, -2] = out[1, :, -1] = 1.0
    return out.reshape(2 * count * q, -1), _share(local[:, :, -1].reshape(2, -1), n)


def rate(_t: float, y: Array, problem: Problem, basis: Basis) -> Array:
    """Time derivative of the packed state.

    With a = J q_tt - c (J = dr/dq, c centripetal) the system is
    [m G^T; G 0] (q_tt, -lambda) = (J^T (rho c + f) - bending, g): Cholesky for m, a 2 x 2 Schur complement.
    """
    n = len(basis.free_points)
    psi, omega = y[:n], y[n : 2 * n]
    theta = basis.points + at_points(psi, basis)
    c, s = np.cos(theta), np.sin(theta)
    w2 = at_points(omega, basis) ** 2
    turn, gap = turning(c, s, basis)
    force, power = _load(problem, basis, c, s, turn @ y[n : 2 * n + 2])
    turn *= basis.root_inertia[:, None]
    mass = turn.T @ turn
    right = np.zeros((n + 2, 3))
    centripetal = basis.root_inertia * integrate(np.stack([c * w2, s * w2]), basis).ravel()
    right[:, 0] = turn.T @ (centripetal + force / basis.root_inertia)
    right[:n, 0] -= basis.slope.T @ (basis.weight * basis.stiffness * (1 + basis.slope @ psi))
    right[:n, 1:] = gap.T
    _, solved, info = lapack.dposv(mass, right, overwrite_a=True, overwrite_b=True)
    if info:
        raise FloatingPointError("the mass matrix is not positive definite")
    target = np.array([basis.weight @ (c * w2), basis.weight @ (s * w2)])
    multiplier = np.linalg.solve(gap @ solved[:n, 1:], target - gap @ solved[:n, 0])
    return np.concatenate([omega, solved[:, 0] + solved[:, 1:] @ multiplier, [power]])


def _load(problem: Problem, basis: Basis, c: Array, s: Array, velocity: Array) -> tuple[Array, float]:
    """Pressure and drag times the weights, [2 Q], and the power dissipated by drag."""
    pressure = problem.p * np.concatenate([-s * basis.weight, c * basis.weight])
    if problem.zeta_perp == 0:
        return pressure, 0.0
    u, v = np.split(velocity, 2)
    along, across = problem.gamma * problem.zeta_perp * (u * c + v * s), problem.zeta_perp * (v * c - u * s)
    drag = np.concatenate([along * c - across * s, along * s + across * c]) * np.tile(basis.weight, 2)
    return pressure - drag, float(drag @ velocity)
