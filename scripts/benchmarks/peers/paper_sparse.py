"""The paper's scheme as it is commonly written: midpoint boxes, BDF2, Newton with scipy's sparse LU.

Unknown at each node: x, y, theta, moment, Fx, Fy; velocities and accelerations follow from the past by BDF2 (first
step: backward Euler). Each cell states the balances at its middle, Eqs. (B.1)-(B.6) with the moment for the curvature.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from scripts.references.problem import PI2, Problem
from scripts.references.shapes import initial_angle

from .interface import Outcome, Peer, grid_of, timed
from .nodes import observe_nodes

Array = NDArray[np.float64]

X, Y, THETA, M, FX, FY = range(6)
FIELDS = 6
LARGEST_UPDATE = 1e-8  # of positions and angles, where Newton ends
MAX_ITERATIONS = 20
SLOW = 0.1  # contraction above which a kept factorization is renewed


@dataclass(frozen=True)
class Grid:
    """N equal cells, cell i between the nodes i and i + 1; with N a multiple of 4, junctions and quarters are nodes."""

    problem: Problem
    h: float
    stiffness: Array  # [N]
    density: Array  # [N]
    rows: NDArray[np.intp]  # of the nonzeros of the Jacobian
    columns: NDArray[np.intp]

    @property
    def size(self) -> int:
        return FIELDS * len(self.stiffness)


class Past(NamedTuple):
    """What BDF2 adds: derivative = rate * value + past, for positions and for velocities [2, N]."""

    rate: float
    position: Array
    velocity: Array


def make_grid(problem: Problem, n: int) -> Grid:
    """Dense 6 x 12 blocks: the zeros in them are few and cost less than picking them out."""
    h = PI2 / n
    segment = np.searchsorted(problem.edges[1:-1], h * (np.arange(n) + 0.5))
    node = np.column_stack([np.arange(n), (np.arange(n) + 1) % n])
    column = (FIELDS * node[:, :, None] + np.arange(FIELDS)).reshape(n, 1, 2 * FIELDS)
    row = (FIELDS * np.arange(n)[:, None] + np.arange(FIELDS))[:, :, None]
    rows, columns = np.broadcast_arrays(row, column)
    return Grid(
        problem,
        h,
        np.array([s.stiffness for s in problem.segments])[segment],
        np.array([s.density for s in problem.segments])[segment],
        rows.ravel(),
        columns.ravel(),
    )


def balances(grid: Grid, z: Array, past: Past) -> tuple[Array, Array]:
    """Residual [N, 6] and its derivative [N, 6, 12] by the values at both ends of each cell, for z [N, 6]."""
    problem, h = grid.problem, grid.h
    p, zeta, gamma = problem.p, problem.zeta_perp, problem.gamma
    following = np.roll(z, -1, axis=0)
    following[-1, THETA] += PI2
    middle = (z + following) / 2
    velocity = past.rate * z[:, :2].T + past.position
    acceleration = past.rate * velocity + past.velocity
    (u, v), (ax, ay) = ((a + np.roll(a, -1, axis=1)) / 2 for a in (velocity, acceleration))
    c, s = np.cos(middle[:, THETA]), np.sin(middle[:, THETA])
    fx, fy = middle[:, FX], middle[:, FY]
    along, drop = u * c + v * s, gamma - 1
    slope = np.empty_like(z)
    slope[:, X], slope[:, Y] = c, s
    slope[:, THETA] = middle[:, M] / grid.stiffness
    slope[:, M] = fx * s - fy * c
    slope[:, FX] = p * s + zeta * (u + drop * along * c) + grid.density * ax
    slope[:, FY] = -p * c + zeta * (v + drop * along * s) + grid.density * ay

    by_middle = np.zeros((len(z), FIELDS, FIELDS))
    turning = v * c - u * s
    by_middle[:, X, THETA], by_middle[:, Y, THETA] = -s, c
    by_middle[:, THETA, M] = 1 / grid.stiffness
    by_middle[:, M, THETA], by_middle[:, M, FX], by_middle[:, M, FY] = fx * c + fy * s, s, -c
    by_middle[:, FX, THETA] = p * c + zeta * drop * (turning * c - along * s)
    by_middle[:, FY, THETA] = p * s + zeta * drop * (turning * s + along * c)
    inertia = grid.density * past.rate**2
    by_middle[:, FX, X] = inertia + past.rate * zeta * (1 + drop * c * c)
    by_middle[:, FY, Y] = inertia + past.rate * zeta * (1 + drop * s * s)
    by_middle[:, FX, Y] = by_middle[:, FY, X] = past.rate * zeta * drop * c * s
    by_middle *= -h / 2
    return following - z - h * slope, np.concatenate([by_middle - np.eye(FIELDS), by_middle + np.eye(FIELDS)], axis=2)


class Newton:
    """Solves a step; keeps the factorization while it contracts, or makes a new one in every iteration."""

    def __init__(self, grid: Grid, *, keeps: bool) -> None:
        self._grid, self._keeps = grid, keeps
        self._factors: SuperLU | None = None
        self._rate = 0.0
        self.iterations = self.factorizations = 0

    def solve(self, z: Array, past: Past) -> Array:
        """The unknowns at the end of the step, from the guess ``z``."""
        if past.rate != self._rate:
            self._factors, self._rate = None, past.rate
        last = np.inf
        for _ in range(MAX_ITERATIONS):
            residual, blocks = balances(self._grid, z, past)
            if self._factors is None or not self._keeps:
                self._factors = self._factored(blocks)
            update = self._factors.solve(-residual.ravel()).reshape(z.shape)
            z = z + update
            self.iterations += 1
            size = float(np.abs(update[:, : THETA + 1]).max())
            if size < LARGEST_UPDATE:
                return z
            if size > SLOW * last:
                self._factors = None
            last = size
        raise RuntimeError("Newton's iteration does not converge")

    def _factored(self, blocks: Array) -> SuperLU:
        self.factorizations += 1
        size = self._grid.size
        return splu(csc_matrix((blocks.ravel(), (self._grid.rows, self._grid.columns)), shape=(size, size)))


def solve(problem: Problem, N: int, dt: float, *, keeps: bool) -> Outcome:
    """Equal steps, at most ``dt`` long, between stated times; each change of their length keeps BDF2's second order."""
    with timed() as clock:
        grid = make_grid(problem, N)
        newton = Newton(grid, keeps=keeps)
        z = _start(grid)
        older, newest = z, z
        velocities = np.zeros((2, 2, N))
        states, before = [(z[:, :2].T, velocities[0])], 0.0
        for left, right in pairwise(problem.times):
            steps = int(np.ceil((right - left) / dt - 1e-9))
            step = (right - left) / steps
            for _ in range(steps):
                past = _past(older, newest, velocities, step, before)
                ratio = step / before if before else 0.0
                z = newton.solve(newest + ratio * (newest - older), past)
                velocities = np.stack([past.rate * z[:, :2].T + past.position, velocities[0]])
                older, newest, before = newest, z, step
            states.append((z[:, :2].T, velocities[0]))
    notes = f"{newton.iterations} iterations, {newton.factorizations} factorizations"
    return Outcome(clock.seconds, observe_nodes(problem, states), notes)


def _past(older: Array, newest: Array, velocities: Array, step: float, before: float) -> Past:
    """BDF2 for steps of two lengths [Hairer, Norsett & Wanner, Solving ODEs I, III.5]; backward Euler at first."""
    if before == 0.0:
        return Past(1 / step, -newest[:, :2].T / step, -velocities[0] / step)
    w = step / before
    rate, last, last_but_one = (1 + 2 * w) / (1 + w) / step, -(1 + w) / step, w**2 / (1 + w) / step
    return Past(
        rate,
        last * newest[:, :2].T + last_but_one * older[:, :2].T,
        last * velocities[0] + last_but_one * velocities[1],
    )


def _start(grid: Grid) -> Array:
    """The shape at rest: angles of the nodes, shifted by sin and cos until the chords close; no forces."""
    n = len(grid.stiffness)
    theta = initial_angle(grid.problem)(grid.h * np.arange(n, dtype=float))
    for _ in range(6):
        middle = (theta + np.append(theta[1:], theta[0] + PI2)) / 2
        c, s = np.cos(middle), np.sin(middle)
        shift = np.linalg.solve([[-s @ s, s @ c], [s @ c, -c @ c]], [c.sum(), s.sum()])
        theta = theta - np.array([np.sin(theta), -np.cos(theta)]).T @ shift
    z = np.zeros((n, FIELDS))
    z[1:, X], z[1:, Y] = grid.h * np.cumsum(c[:-1]), grid.h * np.cumsum(s[:-1])
    z[:, THETA] = theta
    slope = np.diff(theta, append=theta[0] + PI2) / grid.h
    z[:, M] = grid.stiffness * (slope + np.roll(slope, 1)) / 2
    return z


LIMIT = "second-order differences in space and time"
GRID = grid_of(N=[100, 200, 300, 400], dt=[4e-2, 2e-2, 1e-2])
SETTINGS = {"H": GRID, "S": GRID, "D": GRID, "P64": grid_of(N=[100, 200, 300], dt=[2e-3, 1e-3])}
PLAIN = Peer("paper's scheme, sparse LU in every iteration", partial(solve, keeps=False), SETTINGS, LIMIT)
KEPT = Peer("paper's scheme, sparse LU kept", partial(solve, keeps=True), SETTINGS, LIMIT)
