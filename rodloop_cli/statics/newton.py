"""Newton's method for an equilibrium that meets one condition more, the load being unknown too."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import NODAL
from rodloop_cli.physics.rod import LENGTH
from rodloop_cli.statics.bordered import Border, factorized
from rodloop_cli.statics.loaded import Loaded

MOST_ITERATIONS = 15
CONVERGED = 1e-11
ROUND_OFF = 1e-12
"""Residuals below this, relative to 1 + p, cannot be reduced; close to a branching the corrections stay larger than
they are.
"""

SMALL = 1e-4
"""A correction beyond this is not round-off, however small the residual."""

LARGEST_TURN = 1.0
"""A correction that turns the rod by more than this belongs to another equilibrium."""

LOAD_SCALE = 0.3
"""Weight of the load in distances along a branch: 1 radian of turning (root mean square) counts like Δp = 1/0.3."""


class Condition(Protocol):
    """A scalar condition on the loop and its load."""

    def defect(self, loop: Loaded) -> float:
        """Zero where the condition is met."""

    def gradient(self, loop: Loaded) -> tuple[Array, float]:
        """Derivatives by the unknowns (n, 6 + m) and by p."""


@dataclass(frozen=True)
class FixedLoad:
    """The load has a given value."""

    p: float

    def defect(self, loop: Loaded) -> float:
        return loop.p - self.p

    def gradient(self, loop: Loaded) -> tuple[Array, float]:
        return np.zeros_like(loop.unknowns), 1.0


@dataclass(frozen=True)
class FixedArea:
    """The enclosed area has a given value; the load is its multiplier."""

    area: float

    def defect(self, loop: Loaded) -> float:
        return loop.area - self.area

    def gradient(self, loop: Loaded) -> tuple[Array, float]:
        return loop.area_row, 0.0


class Tangent(NamedTuple):
    """A direction: changes of the unknowns (n, 6 + m) and of the load."""

    unknowns: Array
    p: float

    def row(self, loop: Loaded) -> tuple[Array, float]:
        """⟨tangent, ·⟩ = ∮ δΘ · ds/2π + LOAD_SCALE² δp · as derivatives by the unknowns (n, 6 + m) and by p."""
        row = np.zeros_like(self.unknowns)
        row[:, NODAL:] = self.unknowns[:, NODAL:] * loop.weights / LENGTH
        return row, LOAD_SCALE**2 * self.p

    def along(self, loop: Loaded, other: "Tangent") -> float:
        """The product ⟨tangent, other⟩."""
        row, by_load = self.row(loop)
        return float((row * other.unknowns).sum() + by_load * other.p)

    def scaled(self, factor: float) -> "Tangent":
        return Tangent(factor * self.unknowns, factor * self.p)


@dataclass(frozen=True)
class Ahead:
    """The loop lies on the plane at ``distance`` from ``start`` along a unit ``tangent``."""

    start: Loaded
    tangent: Tangent
    distance: float

    def defect(self, loop: Loaded) -> float:
        gone = Tangent(loop.unknowns - self.start.unknowns, loop.p - self.start.p)
        return self.tangent.along(self.start, gone) - self.distance

    def gradient(self, loop: Loaded) -> tuple[Array, float]:
        return self.tangent.row(self.start)


class Solved(NamedTuple):
    """An equilibrium and the iterations it took."""

    loop: Loaded
    iterations: int


def solve(guess: Loaded, condition: Condition) -> Solved:
    """The equilibrium near ``guess`` that meets the condition.

    Raises ConvergenceError if Newton's method does not get there.
    """
    loop, before = guess, np.inf
    for iteration in range(1, MOST_ITERATIONS + 1):
        correction = _correction(loop, condition)
        size = float(np.abs(correction.unknowns[:, NODAL:]).max()) + LOAD_SCALE * abs(correction.p)
        if not size < LARGEST_TURN * max(1.0, LOAD_SCALE * abs(loop.p)):
            break
        loop = loop.moved(*correction)
        if size < CONVERGED or (before / 2 < size < SMALL and _satisfied(loop)):
            return Solved(loop, iteration)
        before = size
    raise ConvergenceError(f"no equilibrium found near p = {guess.p:.6g}")


def _satisfied(loop: Loaded) -> bool:
    return bool(np.abs(loop.residual).max() < ROUND_OFF * (1 + abs(loop.p)))


def tangent_at(loop: Loaded, towards: Tangent) -> Tangent:
    """The unit tangent of the branch through an equilibrium, on the side of ``towards``."""
    row, by_load = towards.row(loop)
    factors = factorized(loop.responses[0], _borders(loop, row, by_load))
    right_hand_side = np.zeros(factors.shape[0])
    right_hand_side[loop.unknowns.size] = 1.0
    tangent = _tangent(loop, factors.solve(right_hand_side))
    return tangent.scaled(tangent.along(loop, tangent) ** -0.5)


def _correction(loop: Loaded, condition: Condition) -> Tangent:
    row, by_load = condition.gradient(loop)
    factors = factorized(loop.responses[0], _borders(loop, row, by_load))
    right_hand_side = np.zeros(factors.shape[0])
    right_hand_side[: loop.unknowns.size] = loop.residual.ravel()
    right_hand_side[loop.unknowns.size] = -condition.defect(loop)
    return _tangent(loop, factors.solve(right_hand_side))


def _borders(loop: Loaded, row: Array, by_load: float) -> tuple[Border, ...]:
    """The load with its condition; for a uniform rod also a force that vanishes in the end, against sliding along its
    shape.
    """
    borders = (Border(-loop.load_response, row, by_load),)
    if loop.relabelling is None:
        return borders
    displacement, turning = loop.relabelling
    against = np.zeros_like(loop.unknowns)
    against[:, NODAL:] = turning * loop.weights / np.abs(turning).max()
    column = loop.response_to(displacement / np.abs(displacement).max())
    return (*borders, Border(column, against))


def _tangent(loop: Loaded, solution: Array) -> Tangent:
    inner = loop.unknowns.size
    return Tangent(solution[:inner].reshape(loop.unknowns.shape), float(solution[inner]))
