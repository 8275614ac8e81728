"""Radau IIA (order 5) of the package solve_dae on the same stabilised index-2 form, sparse LU."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from solve_dae.integrate import solve_dae  # type: ignore[import-not-found, unused-ignore]

from scripts.references.problem import Problem

from .gauss_dae import LoopDAE
from .gauss_grid import FIELDS, PSI, U, V, make_grid, observe
from .interface import Outcome, Peer, grid_of, timed

Array = NDArray[np.float64]

LOOSE = 1e6  # absolute tolerance of forces, moments, omega and mu: as good as none
FIRST_STEP = 1e-4


def solve(problem: Problem, cells: int, tol: float, m: int = 3) -> Outcome:
    """Error control on psi and, ten times looser, on velocities."""
    with timed() as clock:
        grid = make_grid(problem, cells, m)
        dae = LoopDAE(problem, grid)
        y0, yp0 = dae.start()
        field = np.append(np.arange(grid.size - 2) % FIELDS, [FIELDS, FIELDS])
        atol = np.where(field == PSI, tol, np.where((field == U) | (field == V), 10 * tol, LOOSE))

        def residual(_t: float, y: Array, yp: Array) -> Array:
            out = np.empty_like(y)
            dae.residual(y, yp, out)
            return out

        def jacobian(_t: float, y: Array, _yp: Array) -> tuple[csc_matrix, csc_matrix]:
            by_y, by_yp = dae.jacobian_values(y)
            return dae.matrix(by_y), dae.matrix(by_yp)

        found = solve_dae(residual, (0.0, problem.t_end), y0, yp0, method="Radau", t_eval=problem.times, jac=jacobian,
                          rtol=tol, atol=atol, first_step=FIRST_STEP)  # fmt: skip
    if not found.success:
        raise RuntimeError(found.message)
    notes = f"{found.nfev} residuals, {found.njev} Jacobians, {found.nlu} factorizations"
    return Outcome(clock.seconds, observe(problem, grid, found.t, found.y.T), notes)


PEER = Peer(
    "solve_dae Radau, index-2 Gauss collocation",
    solve,
    {
        "H": grid_of(cells=[17, 25], tol=[1e-3, 1e-4, 1e-5, 1e-6]),
        "S": grid_of(cells=[13, 17, 25], tol=[1e-3, 1e-4, 1e-5]),
        "P64": grid_of(cells=[33], tol=[1e-4, 1e-5, 1e-6, 1e-7]),
        "D": grid_of(cells=[17, 33], tol=[1e-3, 1e-4, 1e-5]),
    },
    "time tolerance, and sparse LU from Python at every step (three systems a step, factored anew)",
)
