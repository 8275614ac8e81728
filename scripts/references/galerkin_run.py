"""Integrate the Galerkin form in time and state its observables."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .galerkin import Basis, State, at_points, integrate, make_basis, pack, rate, unpack
from .ivp import march
from .observables import Row, make_row, relative_to_start
from .problem import Problem
from .shapes import initial_angle

Array = NDArray[np.float64]


def solve(problem: Problem, degree: int, per_segment: int = 1, method: str = "DOP853", rtol: float = 1e-10,
          atol: float = 1e-12) -> list[Row]:  # fmt: skip
    """Observables at the stated times; ``method`` is one of scipy's."""
    basis = make_basis(problem, degree, per_segment)
    run = march(rate, start(problem, basis), problem, method, rtol=rtol, atol=atol, args=(problem, basis))
    return observe_all(run.t, run.y, problem, basis)


def start(problem: Problem, basis: Basis) -> Array:
    """The packed state of the loop at rest."""
    psi = initial_angle(problem)(basis.free_points) - basis.free_points
    return pack(State(psi, np.zeros_like(psi), np.zeros(2), 0.0))


def observe_all(times: Array, states: Array, problem: Problem, basis: Basis) -> list[Row]:
    """Observables of the columns of ``states``."""
    return relative_to_start([observe(t, unpack(y), problem, basis) for t, y in zip(times, states.T, strict=True)])


def observe(t: float, state: State, problem: Problem, basis: Basis) -> Row:
    """Area 1/2 int (x y' - y x'), bending 1/2 int b theta'^2, kinetic 1/2 int rho v^2 by the basis's quadrature."""
    theta = basis.points + at_points(state.psi, basis)
    c, s = np.cos(theta), np.sin(theta)
    x, y = integrate(np.stack([c, s]), basis)
    velocity = state.v0[:, None] + integrate(at_points(state.omega, basis) * np.stack([-s, c]), basis)
    curvature = 1 + basis.slope @ state.psi
    return make_row(
        t,
        problem.p,
        area=0.5 * basis.weight @ (x * s - y * c),
        bending=0.5 * float(basis.weight @ (basis.stiffness * curvature**2)),
        kinetic=0.5 * basis.weight @ (basis.density * (velocity**2).sum(axis=0)),
        quarters=basis.quarters @ np.column_stack([c, s]),
        moment=basis.stiffness[0] * (1 + basis.at_start @ state.psi),
        dissipated=state.dissipated,
    )
