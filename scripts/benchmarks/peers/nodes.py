"""Observables of loops given by nodes at equal arclength.

Area, kinetic energy and distances follow the nodes' own accuracy; bending energy and the moment come from a spline that
rounds the curvature's jumps at junctions off, and are rough there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from scripts.references.observables import Row, make_row, relative_to_start
from scripts.references.problem import PI2, Problem

Array = NDArray[np.float64]

REFINEMENT = 8  # points a node spacing


def observe_nodes(problem: Problem, states: list[tuple[Array, Array]]) -> list[Row]:
    """Rows of the stated times from positions and velocities [2, N] at s = 2 pi i / N, N a multiple of 4."""
    return relative_to_start([_row(t, *state, problem) for t, state in zip(problem.times, states, strict=True)])


def _row(t: float, position: Array, velocity: Array, problem: Problem) -> Row:
    """Area and energies of the periodic cubic spline through the nodes (a polygon's area is only second order)."""
    n = position.shape[1]
    s = np.linspace(0, PI2, n + 1)
    curve, speed = (
        CubicSpline(s, np.column_stack([values, values[:, 0]]), axis=1, bc_type="periodic")
        for values in (position, velocity)
    )
    fine = PI2 * (np.arange(REFINEMENT * n) + 0.5) / (REFINEMENT * n)
    segment = np.searchsorted(problem.edges[1:-1], fine, side="right")
    b = np.array([p.stiffness for p in problem.segments])[segment]
    rho = np.array([p.density for p in problem.segments])[segment]
    (x, y), (dx, dy), (ddx, ddy) = curve(fine), curve(fine, 1), curve(fine, 2)
    moment = b * (dx * ddy - dy * ddx)
    return make_row(
        t,
        problem.p,
        area=PI2 * float(np.mean(x * dy - y * dx)) / 2,
        bending=PI2 * float(np.mean(moment**2 / b)) / 2,
        kinetic=PI2 * float(np.mean(rho * (speed(fine) ** 2).sum(axis=0))) / 2,
        quarters=position[:, :: n // 4].T,
        moment=moment[0],
    )
