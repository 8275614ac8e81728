"""Following a branch of equilibria with an eye on its stability.

Where an eigenvalue λ² comes near zero, branches run close together: the steps then shorten in proportion to the
distance still to go, so that an imperfect bifurcation is followed round its bend instead of being jumped.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.stability.compliance import Compliance
from rodloop_cli.statics.branch import FEW_ITERATIONS, FIRST_STEP, LONGEST_STEP, SHORTEST_STEP, BranchPoint
from rodloop_cli.statics.loaded import Loaded

CLOSEST = 1e-5
"""Distance along the branch below which an eigenvalue is taken to pass through zero."""

NEGLIGIBLE = 1e-7
"""A λ² below this, in units of the shift, is zero: a nearly uniform loop turns in its material almost without
resistance.
"""

GRADUAL = 1e-6
"""A change of λ² below this, in the same units, needs no closer look."""

LEADING = 4


@dataclass(frozen=True, eq=False)
class Watched:
    """A point of a branch with the λ² of its small motions without drag."""

    point: BranchPoint

    @property
    def loop(self) -> Loaded:
        return self.point.loop

    @cached_property
    def squares(self) -> Array:
        """(4,): the largest λ²; the equilibrium is stable under its load while all are negative."""
        return self._compliance.squares(self._compliance.matrix)[:LEADING]

    @cached_property
    def squares_at_fixed_area(self) -> Array:
        """(4,): the largest λ² of motions that keep the area; all negative at a minimum of the bending energy at that
        area.
        """
        return self._compliance.squares(self._compliance.at_fixed_area)[:LEADING]

    @property
    def is_stable(self) -> bool:
        return bool(self.squares[0] <= NEGLIGIBLE * self._compliance.shift)

    @property
    def is_minimum(self) -> bool:
        """Whether the bending energy is least at its area, among near shapes."""
        return bool(self.squares_at_fixed_area[0] <= NEGLIGIBLE * self._compliance.shift)

    @property
    def watched(self) -> Array:
        """(8,): all that must not jump, with what is negligible made zero."""
        squares = np.concatenate([self.squares, self.squares_at_fixed_area])
        squares[np.abs(squares) <= NEGLIGIBLE * self._compliance.shift] = 0.0
        return squares

    @cached_property
    def _compliance(self) -> Compliance:
        return Compliance(self.loop, watch_shift(self.loop))


def follow_watched(start: Watched, longest: float = LONGEST_STEP) -> Iterator[Watched]:
    """The points of the branch behind ``start``, without end; where the largest λ² changes sign two are CLOSEST
    together.

    Raises ConvergenceError where the branch cannot be followed.
    """
    before, size = start, min(FIRST_STEP, longest)
    while size > SHORTEST_STEP:
        taken = before.point.step(size)
        here = Watched(taken[0]) if taken else None
        if taken is None or here is None or (size > CLOSEST and _jumped(before, here)):
            size *= 0.4
            continue
        yield here
        wary = _distance_to_zero(before.watched, here.watched, size) / 2
        # Round-off costs iterations close to a branching: no reason to go slower still.
        size = min(longest, max(CLOSEST, min(wary, size * (1.5 if taken[1] <= FEW_ITERATIONS else 0.8))))
        before = here
    raise ConvergenceError(f"the branch of equilibria cannot be followed beyond p = {before.loop.p:.6g}")


def interpolated(before: Watched, here: Watched, low: float, high: float) -> Loaded:
    """The loop between two points of a branch, close together, where what is ``low`` and ``high`` at them is zero."""
    share = min(max(-low / (high - low), 0.0), 1.0)
    return before.loop.moved(share * (here.loop.unknowns - before.loop.unknowns), share * (here.loop.p - before.loop.p))


def watch_shift(loop: Loaded) -> float:
    """Of the size of the lowest frequencies squared, off the eigenvalues that matter, which are negative or near zero.
    Of the size of the lowest frequencies squared, off the eigenvalues that matter, which are negative or near zero.
    """
    mesh = loop.equations.mesh
    return float(mesh.stiffness.min() / mesh.density.max())


def _jumped(before: Watched, here: Watched) -> bool:
    """Whether stability changed, and by more than can be told from a gradual change."""
    if before.is_stable == here.is_stable and before.is_minimum == here.is_minimum:
        return False
    change = np.abs(here.watched - before.watched)
    return bool(min(change[0], change[LEADING]) > GRADUAL * watch_shift(here.loop))


def _distance_to_zero(before: Array, here: Array, step: float) -> float:
    """How far ahead the first of the eigenvalues that approach zero would reach it."""
    approaching = np.abs(before) - np.abs(here)
    closing = (approaching > 0) & (here != 0)
    if not closing.any():
        return np.inf
    return float((np.abs(here[closing]) / approaching[closing]).min() * step)
