"""Fourier differentiation of the reduced (theta, theta_t) form with scipy's Radau and DOP853."""

from __future__ import annotations

from functools import partial

from scripts.references.fourier import closure_gap, jacobian, make_ring, observe, rate, start
from scripts.references.ivp import march
from scripts.references.problem import Problem

from .interface import Outcome, Peer, grid_of, timed


def solve(problem: Problem, method: str, n: int, tol: float) -> Outcome:
    """Dense matrices prepared once, Cholesky for the tension, analytic Jacobian; ``tol`` is absolute and relative."""
    with timed() as clock:
        ring = make_ring(problem, n)
        run = march(rate, start(problem, ring), problem, method, rtol=tol, atol=tol, args=(ring,), jac=jacobian)
    notes = f"{run.nfev} evaluations, {run.njev} Jacobians, closure gap {closure_gap(run.y[:, -1]):.0e}"
    return Outcome(clock.seconds, observe(run.t, run.y, problem), notes)


LIMIT = "points at loose, time tolerance at tight settings; serves neither junctions nor (as written) drag"
RADAU = Peer(
    "Fourier reduced form, scipy Radau",
    partial(solve, method="Radau"),
    {
        "H": grid_of(n=[17, 21], tol=[1e-3, 5e-4, 2e-4, 1e-4])
        + grid_of(n=[25], tol=[1e-4, 5e-5, 2e-5, 1e-5])
        + grid_of(n=[33], tol=[1e-5, 5e-6, 2e-6, 1e-6, 3e-7, 1e-7])
        + grid_of(n=[41], tol=[1e-7, 1e-8]),
        "P64": grid_of(n=[33], tol=[1e-3, 5e-4, 2e-4, 1e-4])
        + grid_of(n=[41], tol=[1e-5, 3e-6, 1e-6])
        + grid_of(n=[49], tol=[1e-6, 1e-7])
        + grid_of(n=[65], tol=[1e-7, 1e-8]),
    },
    LIMIT,
)
DOP853 = Peer(
    "Fourier reduced form, scipy DOP853",
    partial(solve, method="DOP853"),
    {
        "H": grid_of(n=[17, 19, 21, 23, 25], tol=[1e-3, 1e-4])
        + grid_of(n=[29], tol=[1e-4])
        + grid_of(n=[33], tol=[1e-4, 1e-5])
        + grid_of(n=[41], tol=[1e-5, 1e-7])
        + grid_of(n=[49], tol=[1e-9]),
        "P64": grid_of(n=[25, 29, 33, 37, 41, 49, 65], tol=[1e-3, 1e-5]),
    },
    LIMIT + "; explicit: step bounded by stability (square of the number of points)",
)
