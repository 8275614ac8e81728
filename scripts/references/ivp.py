"""scipy's initial value solvers, asked for the stated times of a problem."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from .problem import Problem

Array = NDArray[np.float64]

_solve_ivp: Callable[..., Any] = solve_ivp


def march(rate: Callable[..., Array], start: Array, problem: Problem, method: str, *, rtol: float, atol: float,
          args: tuple[Any, ...], jac: Callable[..., Array] | None = None) -> Any:  # fmt: skip
    """Scipy's result object, states [size, times] in ``y``; only the implicit methods are given the Jacobian."""
    options = {"jac": jac} if jac is not None and method in {"Radau", "BDF", "LSODA"} else {}
    run = _solve_ivp(rate, (0, problem.t_end), start, method, t_eval=problem.times, rtol=rtol, atol=atol, args=args,
                     **options)  # fmt: skip
    if not run.success:
        raise RuntimeError(run.message)
    return run
