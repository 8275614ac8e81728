"""Full linear systems that differ by a number λ, one of them real: LAPACK's LU of each."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from rodloop_cli.errors import SingularSystem
from rodloop_cli.numerics.gauss import Array

Complex = NDArray[np.complex128]


class FullSystems:
    """Factors of the matrices A0 + λ² A1 [+ λ A2] for rates λ (E,), the first of which is real.

    parts: (2 or 3, S, S).  Raises SingularSystem when one of them cannot be factored.
    """

    def __init__(self, parts: Array, rates: Complex) -> None:
        self._factors = [_factors(parts, rate) for rate in (float(rates[0].real), *rates[1:].tolist())]

    def solve(self, right_hand_sides: Complex) -> Complex:
        """(E, S): solutions for right-hand sides of that shape; only the real part of the first is used."""
        solution = np.empty_like(right_hand_sides)
        solution[0] = self.solve_real(right_hand_sides[0].real)
        for i, (factors, pivots) in enumerate(self._factors[1:], start=1):
            # The factors are those of the transposed matrix, which is how LAPACK sees rows.
            solution[i] = lapack.zgetrs(factors, pivots, right_hand_sides[i], trans=1)[0]
        return solution

    def solve_real(self, right_hand_side: Array) -> Array:
        """(S,): solution of the real system alone."""
        factors, pivots = self._factors[0]
        solution: Array = lapack.dgetrs(factors, pivots, right_hand_side, trans=1)[0]
        return solution


def _factors(parts: Array, rate: complex) -> tuple[NDArray[Any], NDArray[np.int32]]:
    matrix = rate**2 * parts[1]
    matrix += parts[0]
    if len(parts) > 2:
        matrix += rate * parts[2]
    factorize = lapack.dgetrf if matrix.dtype.kind == "f" else lapack.zgetrf
    factors, pivots, info = factorize(matrix.T, overwrite_a=1)
    if info != 0:
        raise SingularSystem("the linearised equations of the loop are singular")
    return factors, pivots
