"""The rod loop as an implicit system F(t, y, y') = 0 of index 2, stabilised, for DAE codes (IDA, solve_dae).

Space: polynomials of degree m on each cell, continuous between cells, collocated at the m Gauss points of a cell. With
psi = theta - s the fields are psi, M, Fx, Fy, u, v (m values a cell each) and omega (at the Gauss points):

    1 + psi' = M/b                                     M' = Fx sin theta - Fy cos theta
    F' = -p n + zeta (gamma v_t t + v_n n) + rho v_dot   [two rows]
    v' = omega n                                       [two rows; inextensibility at the level of velocities]
    psi_dot = omega + mu.n                             int t ds = 0       [two rows, two global multipliers mu]

The last line is the Gear-Gupta-Leimkuhler stabilisation: everything else about the shape follows from psi, so that
the closure of the loop is all that can drift. The number of cells and m must be odd: otherwise the interpolation
from the nodal values to the Gauss points has a null vector (a sawtooth) and the initial moment is undetermined.
"""

from __future__ import annotations

import numba  # type: ignore[import-not-found, unused-ignore]
import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import spsolve

from scripts.references.problem import Problem
from scripts.references.shapes import initial_angle

from .gauss_grid import FIELDS, FX, FY, OMEGA, PSI, Grid, M, U, V

Array = NDArray[np.float64]
Load = tuple[float, float, float]  # p, zeta_perp, gamma


def residual(
    y: Array, yp: Array, out: Array, m: int, width: Array, points: Array, weight: Array, value: Array, slope: Array,
    stiffness: Array, density: Array, load: Load,
) -> None:  # fmt: skip
    """F(y, y') into ``out``; ``load`` is (p, zeta_perp, gamma)."""
    cells = width.shape[0]
    n = FIELDS * cells * m
    mu_x, mu_y = y[n], y[n + 1]
    p, zeta, gamma = load
    gap_x = gap_y = 0.0
    z, dz, zt = np.empty(6), np.empty(6), np.empty(6)
    for i in range(cells):
        for g in range(m):
            row = FIELDS * (i * m + g)
            z[:], dz[:], zt[:] = 0.0, 0.0, 0.0
            for k in range(m + 1):
                col = FIELDS * ((i * m + k) % (cells * m))
                e, d = value[g, k], slope[g, k] / width[i]
                for f in range(6):
                    z[f] += e * y[col + f]
                    dz[f] += d * y[col + f]
                    zt[f] += e * yp[col + f]
            theta = points[i * m + g] + z[PSI]
            c, s = np.cos(theta), np.sin(theta)
            omega = y[row + OMEGA]
            along, across = gamma * zeta * (z[U] * c + z[V] * s), zeta * (z[V] * c - z[U] * s)
            out[row] = 1.0 + dz[PSI] - z[M] / stiffness[i]
            out[row + 1] = dz[M] - z[FX] * s + z[FY] * c
            out[row + 2] = dz[FX] - p * s - (along * c - across * s) - density[i] * zt[U]
            out[row + 3] = dz[FY] + p * c - (along * s + across * c) - density[i] * zt[V]
            out[row + 4] = dz[U] + omega * s
            out[row + 5] = dz[V] - omega * c
            out[row + 6] = zt[PSI] - omega + mu_x * s - mu_y * c
            gap_x += weight[i * m + g] * c
            gap_y += weight[i * m + g] * s
    out[n], out[n + 1] = gap_x, gap_y


def jacobian(
    y: Array, data: Array, m: int, width: Array, points: Array, weight: Array, value: Array, slope: Array,
    stiffness: Array, density: Array, load: Load,
) -> None:  # fmt: skip
    """Entries of dF/dy and dF/dy' in the order of ``pattern``; ``data`` is [entries, 2]."""
    cells = width.shape[0]
    n = FIELDS * cells * m
    mu_x, mu_y = y[n], y[n + 1]
    p, zeta, gamma = load
    at = 0
    for i in range(cells):
        for g in range(m):
            row = FIELDS * (i * m + g)
            psi = fx = fy = u = v = 0.0
            for k in range(m + 1):
                col = FIELDS * ((i * m + k) % (cells * m))
                e = value[g, k]
                psi += e * y[col + PSI]
                fx += e * y[col + FX]
                fy += e * y[col + FY]
                u += e * y[col + U]
                v += e * y[col + V]
            theta = points[i * m + g] + psi
            c, s, omega = np.cos(theta), np.sin(theta), y[row + OMEGA]
            vt, vn, rho, h = u * c + v * s, v * c - u * s, density[i], weight[i * m + g]
            turn_x = p * c + zeta * (gamma - 1) * (vn * c - vt * s)  # d(load)/dtheta
            turn_y = p * s + zeta * (gamma - 1) * (vn * s + vt * c)
            xx, xy, yy = zeta * (gamma * c * c + s * s), zeta * (gamma - 1) * s * c, zeta * (gamma * s * s + c * c)
            for k in range(m + 1):
                e, d = value[g, k], slope[g, k] / width[i]
                entries = (
                    (d, 0.0), (-e / stiffness[i], 0.0),
                    (d, 0.0), (-e * s, 0.0), (e * c, 0.0), (-e * (fx * c + fy * s), 0.0),
                    (d, 0.0), (-e * turn_x, 0.0), (-e * xx, -e * rho), (-e * xy, 0.0),
                    (d, 0.0), (-e * turn_y, 0.0), (-e * xy, 0.0), (-e * yy, -e * rho),
                    (d, 0.0), (e * omega * c, 0.0),
                    (d, 0.0), (e * omega * s, 0.0),
                    (e * (mu_x * c + mu_y * s), e),
                    (-e * h * s, 0.0), (e * h * c, 0.0),
                )  # fmt: skip
                for entry in entries:
                    data[at, 0], data[at, 1] = entry
                    at += 1
            for single in (s, -c, -1.0, s, -c):
                data[at, 0], data[at, 1] = single, 0.0
                at += 1


_residual = numba.njit(cache=True, error_model="numpy")(residual)
_jacobian = numba.njit(cache=True, error_model="numpy")(jacobian)


def pattern(grid: Grid) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows and columns of the entries of ``jacobian``."""
    count, n = len(grid.points), FIELDS * len(grid.points)
    by_value = ((0, PSI), (0, M), (1, M), (1, FX), (1, FY), (1, PSI), (2, FX), (2, PSI), (2, U), (2, V), (3, FY),
                (3, PSI), (3, U), (3, V), (4, U), (4, PSI), (5, V), (5, PSI), (6, PSI))  # fmt: skip
    rows, cols = [], []
    for g in range(count):
        row, first = FIELDS * g, g - g % grid.m
        for k in range(grid.m + 1):
            col = FIELDS * ((first + k) % count)
            rows += [row + r for r, _ in by_value] + [n, n + 1]
            cols += [col + f for _, f in by_value] + [col + PSI, col + PSI]
        rows += [row + 4, row + 5, row + 6, row + 6, row + 6]
        cols += [row + OMEGA, row + OMEGA, row + OMEGA, n, n + 1]
    return np.array(rows), np.array(cols)


class LoopDAE:
    """Residual, sparse Jacobian and consistent start of one problem on one grid."""

    def __init__(self, problem: Problem, grid: Grid) -> None:
        self.problem, self.grid = problem, grid
        load = (float(problem.p), float(problem.zeta_perp), float(problem.gamma))
        self._fixed = (grid.m, grid.width, grid.points, grid.weight, grid.value, grid.slope, grid.stiffness,
                       grid.density, load)  # fmt: skip
        rows, cols = pattern(grid)
        self._data = np.zeros((len(rows), 2))
        structure = sparse.csc_matrix((np.ones(len(rows)), (rows, cols)), (grid.size, grid.size))
        structure.sort_indices()
        self.indices, self.indptr = structure.indices, structure.indptr
        keys = np.repeat(np.arange(grid.size), np.diff(self.indptr)) * grid.size + self.indices
        self._slot = np.searchsorted(keys, cols * grid.size + rows)

    def residual(self, y: Array, yp: Array, out: Array) -> None:
        _residual(y, yp, out, *self._fixed)

    def jacobian_values(self, y: Array) -> tuple[Array, Array]:
        """CSC values of dF/dy and dF/dy' on the common pattern."""
        _jacobian(y, self._data, *self._fixed)
        both = np.array([np.bincount(self._slot, column, len(self.indices)) for column in self._data.T], float)
        return both[0], both[1]

    def matrix(self, values: Array) -> sparse.csc_matrix:
        return sparse.csc_matrix((values, self.indices, self.indptr), (self.grid.size, self.grid.size))

    def start(self) -> tuple[Array, Array]:
        """Consistent y and y' of the loop at rest: first M, then F with the accelerations (a linear system)."""
        grid = self.grid
        y, yp = np.zeros(grid.size), np.zeros(grid.size)
        y[PSI:-2:FIELDS] = initial_angle(self.problem)(grid.free_points) - grid.free_points
        self._close(y)
        # rows 0 fix M; rows 1-3 F; rows 4-5 differentiated in time (at rest: the same matrix) fix v_dot and omega_dot
        out = np.empty(grid.size)
        at_rest, by_rate = (self.matrix(v).tocsr() for v in self.jacobian_values(y))
        field = np.append(np.arange(grid.size - 2) % FIELDS, [FIELDS, FIELDS])
        self.residual(y, yp, out)
        m_columns, m_rows = np.flatnonzero(field == M), np.flatnonzero(field == 0)
        y[m_columns] = spsolve(at_rest[m_rows][:, m_columns].tocsc(), -out[m_rows])
        self.residual(y, yp, out)
        rows = np.flatnonzero((field >= 1) & (field <= 5))
        forces = np.flatnonzero((field == FX) | (field == FY))
        rates = np.flatnonzero((field == U) | (field == V) | (field == OMEGA))
        balance = (
            by_rate[rows][:, rates] + sparse.diags_array((field[rows] >= 4).astype(float)) @ at_rest[rows][:, rates]
        )
        found = spsolve(sparse.hstack([at_rest[rows][:, forces], balance]).tocsc(), -out[rows])
        y[forces], yp[rates] = found[: len(forces)], found[len(forces) :]
        return y, yp

    def _close(self, y: Array) -> None:
        """Shift psi by combinations of sin and cos theta until the discrete loop closes (Newton)."""
        out, zero = np.empty(self.grid.size), np.zeros(self.grid.size)
        theta = self.grid.free_points + y[PSI:-2:FIELDS]
        shift = np.column_stack([np.sin(theta), -np.cos(theta)])
        for _ in range(4):
            self.residual(y, zero, out)
            slope = self.matrix(self.jacobian_values(y)[0])[-2:, PSI:-2:FIELDS] @ shift
            y[PSI:-2:FIELDS] -= shift @ np.linalg.solve(slope, out[-2:])
