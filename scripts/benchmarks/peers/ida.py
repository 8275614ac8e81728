"""SUNDIALS IDA (BDF of variable order) through scikit-sundae, on the stabilised index-2 form compiled residual."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sksundae.ida import IDA  # type: ignore[import-not-found, unused-ignore]

from scripts.references.problem import Problem

from .gauss_dae import LoopDAE
from .gauss_grid import FIELDS, PSI, U, V, make_grid, observe
from .interface import Outcome, Peer, grid_of, timed

Array = NDArray[np.float64]

LOOSE = 1e6  # absolute tolerance of forces, moments, omega and mu: as good as none
MAX_STEPS = 20_000  # between stated times: a hundred times what an undisturbed run takes


def solve(problem: Problem, cells: int = 25, m: int = 3, tol: float = 1e-5, max_order: int = 5) -> Outcome:
    """Error control on psi and, ten times looser, on velocities; the other fields are algebraic."""
    with timed() as clock:
        grid = make_grid(problem, cells, m)
        dae = LoopDAE(problem, grid)
        y0, yp0 = dae.start()
        field = np.append(np.arange(grid.size - 2) % FIELDS, [FIELDS, FIELDS])
        differential = np.isin(field, (PSI, U, V))
        atol = np.where(field == PSI, tol, np.where(differential, 10 * tol, LOOSE))

        def jacobian(_t: float, y: Array, _yp: Array, _res: Array, cj: float, out: Array) -> None:
            by_y, by_yp = dae.jacobian_values(y)
            out[:] = by_y + cj * by_yp

        solver = IDA(
            lambda _t, y, yp, out: dae.residual(y, yp, out),
            jacfn=jacobian,
            linsolver="sparse",
            sparsity=dae.matrix(np.ones(len(dae.indices))),
            algebraic_idx=np.flatnonzero(~differential),
            rtol=1e-15,
            atol=atol,
            max_order=max_order,
            max_num_steps=MAX_STEPS,
        )
        found = solver.solve(np.array(problem.times, float), y0, yp0)
    if not found.success:
        raise RuntimeError(found.message)
    notes = f"{found.nfev} residuals, {found.njev} Jacobians"
    return Outcome(clock.seconds, observe(problem, grid, found.t, found.y), notes)


BOX = grid_of(cells=[65, 129, 257], m=[1], tol=[1e-5, 1e-7], max_order=[2])  # second order in space
FAST = grid_of(cells=[17], tol=[1e-4, 1e-5], max_order=[3, 5])
PEER = Peer(
    "SUNDIALS IDA, index-2 Gauss collocation",
    solve,
    {
        "H": grid_of(cells=[13, 17, 25], tol=[1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 1e-9], max_order=[2]) + BOX + FAST,
        "S": grid_of(cells=[9, 13, 17, 25], tol=[1e-4, 3e-5, 1e-5, 3e-6, 1e-6], max_order=[2])
        + grid_of(cells=[9], m=[5], tol=[1e-5, 1e-6], max_order=[2])
        + grid_of(cells=[25, 41], tol=[1e-7], max_order=[2])
        + BOX
        + FAST,
        "P64": grid_of(cells=[33, 49], tol=[1e-5, 1e-6, 1e-7, 1e-8, 1e-9], max_order=[2, 5]),
        "D": grid_of(cells=[13, 17, 33], tol=[1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7], max_order=[2]) + FAST,
    },
    "BDF of order 2; higher orders are unstable for undamped bending waves and creep or fail (listed to show it)",
)
