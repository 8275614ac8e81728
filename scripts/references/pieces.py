"""Integration along the loop of fields that are smooth between given points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from .observables import Row, make_row

Array = NDArray[np.float64]


def primitives(x: Array, gauss: Array, w: Array) -> Array:
    """Rows that integrate from -1 to each x the interpolant through Gauss points: int P_k = (P_k+1 - P_k-1)/(2k+1)."""
    q = len(gauss)
    to_modes = (np.arange(q) + 0.5)[:, None] * legendre.legvander(gauss, q - 1).T * w
    P = legendre.legvander(x, q)
    return np.column_stack([x + 1, (P[:, 2:] - P[:, :-2]) / (2 * np.arange(1, q) + 1)]) @ to_modes


@dataclass(frozen=True)
class Pieces:
    """B intervals between ``breaks`` [B + 1] with q Gauss points each; fields are sampled as [B, q]."""

    breaks: Array
    points: Array  # [B, q]
    weight: Array  # [B, q]
    running: Array  # [q, q] from -1 to each Gauss point

    @classmethod
    def between(cls, breaks: Array, q: int) -> Pieces:
        """Breaks are made unique and joined by the quarter points, where positions are stated."""
        breaks = np.sort(np.concatenate([breaks, np.pi / 2 * np.arange(5)]))
        breaks = breaks[np.append(True, np.diff(breaks) > 1e-9)]
        gauss, w = legendre.leggauss(q)
        half, middle = np.diff(breaks) / 2, (breaks[1:] + breaks[:-1]) / 2
        points, weight = middle[:, None] + np.outer(half, gauss), np.outer(half, w)
        return cls(breaks, points, weight, primitives(gauss, gauss, w))

    def integrate(self, values: Array) -> tuple[Array, Array]:
        """int_0^s of a field at the points [B, q] and at the breaks [B + 1]."""
        ends = np.concatenate([[0.0], np.cumsum((self.weight * values).sum(axis=1))])
        half = np.diff(self.breaks)[:, None] / 2
        return ends[:-1, None] + half * (values @ self.running.T), ends

    def total(self, values: Array) -> float:
        return float((self.weight * values).sum())


def observe_fields(t: float, p: float, pieces: Pieces, theta: Array, bending: Array, kinetic: Array,
                   moment: float) -> Row:  # fmt: skip
    """Observables from theta and the densities of bending and kinetic energy at the points of ``pieces``."""
    c, s = np.cos(theta), np.sin(theta)
    (x, x_ends), (y, y_ends) = pieces.integrate(c), pieces.integrate(s)
    quarters = np.searchsorted(pieces.breaks, np.pi / 2 * np.arange(4) - 1e-6)
    return make_row(
        t,
        p,
        area=0.5 * pieces.total(x * s - y * c),
        bending=pieces.total(bending),
        kinetic=pieces.total(kinetic),
        quarters=np.column_stack([x_ends, y_ends])[quarters],
        moment=moment,
    )
