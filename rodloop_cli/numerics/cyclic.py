"""Direct solution of periodic block-bidiagonal systems ``z_{i+1} - G_i z_i = r_i``, i = 0 … n-1, z_n = z_0.

Marching z through the loop is unstable: its fundamental solutions grow like exp(s √λ). Folding the loop flat, the
nodes in the order 0, n-1, 1, n-2, … and the equations in the order n-1, 0, n-2, 1, …, turns the system into a banded
one in which block row r touches the block columns r-1 and r+1 alone, the wrap-around included: LAPACK's banded LU
with pivoting then does it in O(n).
"""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from rodloop_cli.errors import SingularSystem

Indices = NDArray[np.intp]
AnyArray = NDArray[Any]


@dataclass(frozen=True, eq=False)
class FoldedLayout:
    """Where the blocks of an n-node loop with b unknowns a node stand in LAPACK's band storage.

    node_order, equation_order: (n,) the node (equation) at each block position;  node_position: (n,) its inverse;
    transfer_entries: (n b b,) flat indices of the entries of -G_i;  identity_entries: (n b,) of the ones that multiply
    z_{i+1}.
    """

    nodes: int
    block: int
    band: int
    node_order: Indices
    node_position: Indices
    equation_order: Indices
    transfer_entries: Indices
    identity_entries: Indices

    @property
    def storage_shape(self) -> tuple[int, int]:
        """Rows and columns of the band storage, fill-in included."""
        return 3 * self.band + 1, self.nodes * self.block


@cache
def folded_layout(nodes: int, block: int) -> FoldedLayout:
    """Layout for a loop of at least two nodes; small and shared."""
    node_order = np.array([j // 2 if j % 2 == 0 else nodes - 1 - j // 2 for j in range(nodes)])
    equation_order = np.array([nodes - 1 - j // 2 if j % 2 == 0 else j // 2 for j in range(nodes)])
    node_position, equation_position = np.argsort(node_order), np.argsort(equation_order)
    band = 2 * block - 1
    left, right = node_position, np.roll(node_position, -1)
    entry = np.arange(block)
    rows = equation_position[:, None] * block + entry
    transfer = _band_index(rows[:, :, None], (left[:, None] * block + entry)[:, None, :], band)
    identity = _band_index(rows, right[:, None] * block + entry, band)
    return FoldedLayout(
        nodes, block, band, node_order, node_position, equation_order, transfer.ravel(), identity.ravel()
    )


def _band_index(row: Indices, column: Indices, band: int) -> Indices:
    """Flat index in Fortran-ordered storage with ``band`` extra rows for the fill-in."""
    index: Indices = (2 * band + row - column) + column * (3 * band + 1)
    return index


class CyclicFactorization:
    """LU factors of one periodic system; real if ``transfers`` (n, b, b) is real, complex otherwise.

    Raises SingularSystem if a pivot vanishes.
    """

    def __init__(self, transfers: AnyArray) -> None:
        nodes, block, _ = transfers.shape
        self.layout = layout = folded_layout(nodes, block)
        rows, columns = layout.storage_shape
        storage = np.zeros(rows * columns, dtype=transfers.dtype)
        storage[layout.transfer_entries] = transfers.ravel()
        np.negative(storage, out=storage)
        storage[layout.identity_entries] += 1.0
        real = transfers.dtype.kind == "f"
        factorize, self._solve = (lapack.dgbtrf, lapack.dgbtrs) if real else (lapack.zgbtrf, lapack.zgbtrs)
        band = storage.reshape((rows, columns), order="F")
        self._factors, self._pivots, info = factorize(band, layout.band, layout.band, overwrite_ab=1)
        if info != 0:
            raise SingularSystem(f"pivot {info} of the periodic system vanishes")

    def solve(self, right_hand_side: AnyArray) -> AnyArray:
        """z (n, b) for the right-hand side r (n, b)."""
        layout = self.layout
        folded = right_hand_side[layout.equation_order].reshape(-1)
        solution, _ = self._solve(self._factors, layout.band, layout.band, folded, self._pivots, overwrite_b=1)
        unfolded: AnyArray = solution.reshape(layout.nodes, layout.block)[layout.node_position]
        return unfolded
