"""Closed chain of N rigid links, classical Runge-Kutta, compiled: the simplest thing that works.

Link i has the angle theta_i and the tension T_i; node i the mass m_i = rho h and the moment
M_i = b (theta_i - theta_i-1)/h, b the harmonic mean of its two links. With V_i = -(M_i+1 - M_i)/h and f_i the pressure
(exact gradient of the area) and drag,

    m_i a_i = (T t + V n)_i - (T t + V n)_i-1 + f_i,     (a_i+1 - a_i).t_i = - h omega_i^2

is a cyclic tridiagonal system for T; then omega_i' = (a_i+1 - a_i).n_i / h. The state is theta, omega, v_0.
"""

from __future__ import annotations

from itertools import pairwise

import numba  # type: ignore[import-not-found, unused-ignore]
import numpy as np
from numpy.typing import NDArray

from scripts.references.problem import PI2, Problem
from scripts.references.shapes import initial_angle

from .interface import Outcome, Peer, grid_of, timed
from .nodes import observe_nodes

Array = NDArray[np.float64]
Load = tuple[float, float, float]  # p, zeta_perp, gamma

COURANT = 0.6  # times h^2/sqrt(b): just inside the stability limit of RK4, 2.8/(4 sqrt(b)/h^2)


def _solve_cyclic(lower: Array, diagonal: Array, upper: Array, right: Array, work: Array) -> None:
    """Thomas algorithm with a Sherman-Morrison correction for the two corners; the solution replaces ``right``."""
    n = len(right)
    gamma, top, bottom = -diagonal[0], lower[0], upper[n - 1]
    diagonal[0] -= gamma
    diagonal[n - 1] -= top * bottom / gamma
    work[:] = 0.0
    work[0], work[n - 1] = gamma, bottom
    for i in range(1, n):
        factor = lower[i] / diagonal[i - 1]
        diagonal[i] -= factor * upper[i - 1]
        right[i] -= factor * right[i - 1]
        work[i] -= factor * work[i - 1]
    right[n - 1] /= diagonal[n - 1]
    work[n - 1] /= diagonal[n - 1]
    for i in range(n - 2, -1, -1):
        right[i] = (right[i] - upper[i] * right[i + 1]) / diagonal[i]
        work[i] = (work[i] - upper[i] * work[i + 1]) / diagonal[i]
    share = (right[0] + top * right[n - 1] / gamma) / (1 + work[0] + top * work[n - 1] / gamma)
    right -= share * work


_cyclic = numba.njit(cache=True)(_solve_cyclic)


def _rate(y: Array, out: Array, b: Array, mass: Array, load: Load, work: Array) -> None:
    """Time derivative of the state; ``work`` [11, N] is scratch."""
    n = len(b)
    h, (p, zeta, gamma) = PI2 / n, load
    c, s, shear, fx, fy, lower, diagonal, upper, tension, ax, ay = work
    for i in range(n):
        c[i], s[i] = np.cos(y[i]), np.sin(y[i])
        before, after = (i - 1) % n, (i + 1) % n
        here = b[i] * (y[i] - y[before] + PI2 * (i == 0))
        there = b[after] * (y[after] - y[i] + PI2 * (i == n - 1))
        shear[i] = (here - there) / h**2
    u, v = y[2 * n], y[2 * n + 1]
    for i in range(n):
        dx, dy = 0.5 * (c[i] + c[i - 1]), 0.5 * (s[i] + s[i - 1])
        along, across = gamma * zeta * (u * dx + v * dy), zeta * (v * dx - u * dy)
        scale = h / (dx * dx + dy * dy)
        fx[i] = -p * h * dy - scale * (along * dx - across * dy) - shear[i] * s[i] + shear[i - 1] * s[i - 1]
        fy[i] = p * h * dx - scale * (along * dy + across * dx) + shear[i] * c[i] - shear[i - 1] * c[i - 1]
        u -= h * y[n + i] * s[i]
        v += h * y[n + i] * c[i]
    for i in range(n):
        after = (i + 1) % n
        lower[i] = (c[i] * c[i - 1] + s[i] * s[i - 1]) / mass[i]
        upper[i] = (c[i] * c[after] + s[i] * s[after]) / mass[after]
        diagonal[i] = -1 / mass[i] - 1 / mass[after]
        jump = (fx[after] / mass[after] - fx[i] / mass[i]) * c[i] + (fy[after] / mass[after] - fy[i] / mass[i]) * s[i]
        tension[i] = -h * y[n + i] ** 2 - jump
    _cyclic(lower, diagonal, upper, tension, ax)
    for i in range(n):
        ax[i] = (fx[i] + tension[i] * c[i] - tension[i - 1] * c[i - 1]) / mass[i]
        ay[i] = (fy[i] + tension[i] * s[i] - tension[i - 1] * s[i - 1]) / mass[i]
    for i in range(n):
        after = (i + 1) % n
        out[i] = y[n + i]
        out[n + i] = ((ay[after] - ay[i]) * c[i] - (ax[after] - ax[i]) * s[i]) / h
    out[2 * n], out[2 * n + 1] = ax[0], ay[0]


_compiled_rate = numba.njit(cache=True, error_model="numpy")(_rate)


def _run(y: Array, steps: int, dt: float, b: Array, mass: Array, load: Load) -> None:
    """Classical Runge-Kutta steps, in place."""
    k, work = np.empty((4, len(y))), np.empty((11, len(b)))
    for _ in range(steps):
        _compiled_rate(y, k[0], b, mass, load, work)
        _compiled_rate(y + 0.5 * dt * k[0], k[1], b, mass, load, work)
        _compiled_rate(y + 0.5 * dt * k[1], k[2], b, mass, load, work)
        _compiled_rate(y + dt * k[2], k[3], b, mass, load, work)
        y += dt / 6 * (k[0] + 2 * k[1] + 2 * k[2] + k[3])


_compiled_run = numba.njit(cache=True)(_run)


def solve(problem: Problem, links: int) -> Outcome:
    """Equal steps between stated times, as long as stability permits: the error is that of space."""
    with timed() as clock:
        h = PI2 / links
        segment = np.searchsorted(problem.edges[1:-1], h * (np.arange(links) + 0.5))
        stiffness = np.array([s.stiffness for s in problem.segments])[segment]
        density = np.array([s.density for s in problem.segments])[segment]
        b = 2 / (1 / stiffness + 1 / np.roll(stiffness, 1))
        mass = h * (density + np.roll(density, 1)) / 2
        load = (float(problem.p), float(problem.zeta_perp), float(problem.gamma))
        y = np.concatenate([_closed_angles(problem, links), np.zeros(links + 2)])
        longest = COURANT * h**2 * float(np.sqrt(np.min(mass / h) / np.max(b)))
        states = [_nodes(y)]
        for left, right in pairwise(problem.times):
            steps = int(np.ceil((right - left) / longest))
            _compiled_run(y, steps, (right - left) / steps, b, mass, load)
            states.append(_nodes(y))
    gap = np.abs(np.exp(1j * y[:links]).sum()) * h
    return Outcome(clock.seconds, observe_nodes(problem, states), f"closure gap {gap:.0e}")


def _closed_angles(problem: Problem, links: int) -> Array:
    """The shape's angle at the middle of the links, shifted by sin and cos theta until the polygon closes."""
    theta = initial_angle(problem)((np.arange(links) + 0.5) * PI2 / links)
    for _ in range(5):
        c, s = np.cos(theta), np.sin(theta)
        theta -= np.array([s, -c]).T @ np.linalg.solve([[-s @ s, s @ c], [s @ c, -c @ c]], [c.sum(), s.sum()])
    return theta


def _nodes(y: Array) -> tuple[Array, Array]:
    """Positions and velocities [2, N] of the nodes."""
    n = (len(y) - 2) // 2
    c, s = np.cos(y[:n]), np.sin(y[:n])
    r = np.cumsum(PI2 / n * np.array([c, s]), axis=1)
    v = y[2 * n :, None] + np.cumsum(PI2 / n * y[n : 2 * n] * np.array([-s, c]), axis=1)
    return np.roll(r, 1, axis=1) - r[:, -1:] * (np.arange(n) == 0), np.column_stack([y[2 * n :], v[:, :-1]])


PEER = Peer(
    "polygon differences, compiled RK4",
    solve,
    {
        "H": grid_of(links=[64, 128, 256]),
        "S": grid_of(links=[64, 128, 256, 512]),
        "D": grid_of(links=[64, 128, 256]),
        "P64": grid_of(links=[128, 256, 512]),
    },
    "second-order differences; the stable step shrinks with the square of the link length",
)
