"""Cells with Gauss points for the DAE peers, and the observables of polynomials on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from scripts.references.observables import Row, relative_to_start
from scripts.references.pieces import Pieces, observe_fields
from scripts.references.problem import Problem

Array = NDArray[np.float64]

FINE_POINTS = 10  # Gauss points of the observables' rule in each cell
PSI, M, FX, FY, U, V, OMEGA = range(7)
FIELDS = 7


def lobatto(m: int) -> Array:
    """m + 1 Lobatto points on [0, 1]: where the values of a cell's polynomials are kept."""
    inner = np.sort(legendre.Legendre.basis(m).deriv().roots().real)
    return np.asarray(np.concatenate([[0.0], (1 + inner) / 2, [1.0]]), float)


def power_basis(m: int) -> Array:
    """From the values at the Lobatto points to the coefficients of 1, x, x^2, ..."""
    return np.asarray(np.linalg.inv(np.vander(lobatto(m), increasing=True)), float)


@dataclass(frozen=True)
class Grid:
    """C cells with m Gauss points; y has 7 C m values (cell, point, field) and mu."""

    m: int
    width: Array  # [C]
    free_points: Array  # [C m] where the polynomials' values are, the Gauss points excepted
    points: Array  # [C m] Gauss points
    weight: Array  # [C m]
    value: Array  # [m, m + 1] from the values of a cell and the first of the next one to the Gauss points
    slope: Array  # [m, m + 1] derivative by the local coordinate in [0, 1]
    stiffness: Array  # [C]
    density: Array  # [C]

    @property
    def size(self) -> int:
        return FIELDS * len(self.points) + 2


def make_grid(problem: Problem, cells: int, m: int = 3) -> Grid:
    """``cells`` is spread over the segments in proportion to their length, one more in the first if the sum is even."""
    counts = [max(1, round(cells * s.fraction)) for s in problem.segments]
    counts[0] += 1 - sum(counts) % 2
    if m % 2 == 0:
        raise ValueError("m must be odd")
    widths = [np.full(n, 2 * np.pi * s.fraction / n) for n, s in zip(counts, problem.segments, strict=True)]
    width = np.concatenate(widths)
    left = np.concatenate([[0], np.cumsum(width)[:-1]])[:, None]
    gauss, w = legendre.leggauss(m)
    gauss, w = (1 + gauss) / 2, w / 2
    to_powers = power_basis(m)
    powers = np.arange(1, m + 1)
    slope = np.column_stack([np.zeros(m), powers * gauss[:, None] ** (powers - 1)]) @ to_powers
    return Grid(
        m=m,
        width=width,
        free_points=(left + np.outer(width, lobatto(m)[:-1])).ravel(),
        points=(left + np.outer(width, gauss)).ravel(),
        weight=np.outer(width, w).ravel(),
        value=np.vander(gauss, m + 1, increasing=True) @ to_powers,
        slope=slope,
        stiffness=np.concatenate([np.full(n, s.stiffness) for n, s in zip(counts, problem.segments, strict=True)]),
        density=np.concatenate([np.full(n, s.density) for n, s in zip(counts, problem.segments, strict=True)]),
    )


def observe(problem: Problem, grid: Grid, times: Array, states: Array) -> list[Row]:
    """Observables of the rows of ``states``: the cells' polynomials are evaluated on a finer rule."""
    m = grid.m
    edges = np.concatenate([[0], np.cumsum(grid.width)])
    pieces = Pieces.between(edges, FINE_POINTS)
    cell = np.clip(np.searchsorted(edges, pieces.points, side="right") - 1, 0, len(grid.width) - 1)
    local = (pieces.points - edges[cell]) / grid.width[cell]
    value = np.vander(local.ravel(), m + 1, increasing=True) @ power_basis(m)
    column = (cell.ravel()[:, None] * m + np.arange(m + 1)) % len(grid.points)
    b, rho = grid.stiffness[cell], grid.density[cell]

    def row(t: float, y: Array) -> Row:
        fields = y[:-2].reshape(-1, FIELDS)[column]
        psi, moment, u, v = ((value * fields[..., f]).sum(axis=1).reshape(cell.shape) for f in (PSI, M, U, V))
        kinetic = rho * (u**2 + v**2) / 2
        return observe_fields(t, problem.p, pieces, pieces.points + psi, moment**2 / (2 * b), kinetic, y[M])

    return relative_to_start([row(t, y) for t, y in zip(times, states, strict=True)])
