"""Box systems with the unknowns inside each cell eliminated.

Every cell responds to its own unknowns, the b nodal values at its left end and m inner ones, by a matrix R = [[A, B],
[C, D]] of size b + m: nodal values at its right end and inner values. The linearised system is

    δz_{i+1} - A δz_i - B δw = r_i,      δw - C δz_i - D δw = q_i

With w gone the transfer G = A + B (I - D)^-1 C couples neighbouring nodes alone: m × m inverses, all cells at once,
then `cyclic`.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.numerics.cyclic import CyclicFactorization

AnyArray = NDArray[Any]


class CondensedSystems:
    """Factors of several box systems that share a mesh.

    responses: (E, n, b + m, b + m); system 0 is real (its imaginary part is dropped), the others complex; or
    all of a real type.
    Raises SingularSystem when one of them cannot be factored.
    """

    def __init__(self, responses: AnyArray, block: int) -> None:
        self._block = block
        inner = np.negative(responses[..., block:, block:])
        diagonal = np.arange(inner.shape[-1])
        inner[..., diagonal, diagonal] += 1
        self._inverse = np.linalg.inv(inner)
        self._inner_from_nodes = self._inverse @ responses[..., block:, :block]
        self._ends_from_inner = responses[..., :block, block:] @ self._inverse
        transfers = responses[..., :block, :block] + self._ends_from_inner @ responses[..., block:, :block]
        self._loops = [
            CyclicFactorization(np.ascontiguousarray(transfer.real) if i == 0 else transfer)
            for i, transfer in enumerate(transfers)
        ]

    def solve(self, right_hand_sides: AnyArray) -> AnyArray:
        """(E, n, b + m): solutions for right-hand sides of that shape."""
        block = self._block
        solution = np.empty_like(right_hand_sides)
        inner = right_hand_sides[..., block:, None]
        ends = right_hand_sides[..., :block] + (self._ends_from_inner @ inner)[..., 0]
        solution[0, :, :block] = self._loops[0].solve(ends[0].real)
        for i, loop in enumerate(self._loops[1:], start=1):
            solution[i, :, :block] = loop.solve(ends[i])
        solution[..., block:] = (self._inverse @ inner + self._inner_from_nodes @ solution[..., :block, None])[..., 0]
        return solution

    def solve_real(self, right_hand_side: AnyArray) -> AnyArray:
        """(n, b + m): solution of the real system alone."""
        block = self._block
        inner = right_hand_side[:, block:, None]
        ends = right_hand_side[:, :block] + (self._ends_from_inner[0].real @ inner)[..., 0]
        nodes = self._loops[0].solve(ends)
        values = self._inverse[0].real @ inner + self._inner_from_nodes[0].real @ nodes[..., None]
        return np.concatenate([nodes, values[..., 0]], axis=1)
