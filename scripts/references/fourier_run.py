"""Integrate the Fourier reduced form in time and state its observables."""

from __future__ import annotations

from .fourier import jacobian, make_ring, observe, rate, start
from .ivp import march
from .observables import Row
from .problem import Problem


def solve(problem: Problem, n: int, method: str = "DOP853", rtol: float = 1e-12, atol: float = 1e-13) -> list[Row]:
    """Observables at the stated times from ``n`` points (made odd); ``method`` is one of scipy's."""
    ring = make_ring(problem, n)
    run = march(rate, start(problem, ring), problem, method, rtol=rtol, atol=atol, args=(ring,), jac=jacobian)
    return observe(run.t, run.y, problem)
