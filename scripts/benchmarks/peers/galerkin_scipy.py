"""Piecewise polynomial Galerkin form in theta alone (the references' method for junctions) with scipy's integrators."""

from __future__ import annotations

from functools import partial

from scripts.references.galerkin import make_basis, rate
from scripts.references.galerkin_run import observe_all, start
from scripts.references.ivp import march
from scripts.references.problem import Problem

from .interface import Outcome, Peer, grid_of, timed


def solve(problem: Problem, method: str, degree: int, per_segment: int, tol: float) -> Outcome:
    """Dense mass matrix by Cholesky at every evaluation; Radau's Jacobian by finite differences (scipy's own)."""
    with timed() as clock:
        basis = make_basis(problem, degree, per_segment)
        run = march(rate, start(problem, basis), problem, method, rtol=tol, atol=tol, args=(problem, basis))
    rows = observe_all(run.t, run.y, problem, basis)
    return Outcome(clock.seconds, rows, f"{run.nfev} evaluations, {run.njev} Jacobians")


LIMIT = "polynomial degree: bending waves from the impulsive start converge like (unknowns)^-4"
IMPLICIT = grid_of(degree=[6, 8, 10, 14], per_segment=[1], tol=[1e-2, 1e-3])
EXPLICIT = grid_of(degree=[6, 8, 10], per_segment=[1], tol=[1e-2, 1e-3])
RADAU = Peer("Galerkin in theta, scipy Radau", partial(solve, method="Radau"), {"S": IMPLICIT, "D": IMPLICIT}, LIMIT)
DOP853 = Peer(
    "Galerkin in theta, scipy DOP853",
    partial(solve, method="DOP853"),
    {"S": EXPLICIT, "D": EXPLICIT},
    LIMIT + "; explicit: step bounded by stability (fourth power of the degree)",
)
