"""Branches of equilibria, followed by pseudo-arclength: through folds, and never to another branch.

A step goes along the tangent and is corrected on the plane across it [Keller 1977; Allgower & Georg, Numerical
continuation methods]. It is refused if the branch turned sharply in it: that is how a jump to a neighbouring branch
looks.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.statics.loaded import Loaded
from rodloop_cli.statics.newton import Ahead, FixedLoad, Tangent, solve, tangent_at

FIRST_STEP = 0.03
LONGEST_STEP = 0.3
SHORTEST_STEP = 1e-7
SHARPEST_TURN = 0.9
"""Least cosine of the angle between tangents a step apart."""

FEW_ITERATIONS = 4


@dataclass(frozen=True, eq=False)
class BranchPoint:
    """An equilibrium with the unit tangent of its branch, at ``distance`` from the branch's first point."""

    loop: Loaded
    tangent: Tangent
    distance: float = 0.0

    @classmethod
    def first(cls, loop: Loaded, *, rising: bool = True) -> "BranchPoint":
        """The start of a branch, in the direction of rising (falling) load."""
        load_alone = Tangent(np.zeros_like(loop.unknowns), 1.0 if rising else -1.0)
        return cls(loop, tangent_at(loop, load_alone))

    def ahead(self, distance: float) -> Loaded:
        """The equilibrium at ``distance`` along the tangent, either way. Raises ConvergenceError if it is too far."""
        return self._corrected(distance)[0]

    def step(self, distance: float) -> tuple["BranchPoint", int] | None:
        """The next point and the iterations it took; None where the step is too long."""
        try:
            loop, iterations = self._corrected(distance)
            tangent = tangent_at(loop, self.tangent)
        except ConvergenceError:
            return None
        if tangent.along(loop, self.tangent) < SHARPEST_TURN:
            return None
        return BranchPoint(loop, tangent, self.distance + distance), iterations

    def _corrected(self, distance: float) -> tuple[Loaded, int]:
        guess = self.loop.moved(*self.tangent.scaled(distance))
        return solve(guess, Ahead(self.loop, self.tangent, distance))


def follow(point: BranchPoint, longest: float = LONGEST_STEP) -> Iterator[BranchPoint]:
    """The points of the branch behind ``point``, without end: whoever asks for them stops.

    Raises ConvergenceError where the branch cannot be followed.
    """
    size = min(FIRST_STEP, longest)
    while size > SHORTEST_STEP:
        taken = point.step(size)
        if taken is None:
            size *= 0.4
            continue
        point, iterations = taken
        yield point
        size = min(longest, size * (1.5 if iterations <= FEW_ITERATIONS else 0.8))
    raise ConvergenceError(f"the branch of equilibria cannot be followed beyond p = {point.loop.p:.6g}")


def to_load(start: Loaded, p: float) -> Loaded:
    """The equilibrium at load p on the branch through ``start``: the first one there, if the branch folds.

    Raises ConvergenceError if the branch turns back before.
    """
    if p == start.p:
        return start
    rising = p > start.p
    before = BranchPoint.first(start, rising=rising)
    for point in follow(before):
        if (point.loop.p >= p) == rising:
            return _landed(before, point, p)
        if (point.tangent.p > 0) != rising:
            raise ConvergenceError(f"the equilibria from p = {start.p:g} on turn back at p = {point.loop.p:.6g}")
        before = point
    raise AssertionError("a branch has no end")


def _landed(before: BranchPoint, behind: BranchPoint, p: float) -> Loaded:
    share = (p - before.loop.p) / (behind.loop.p - before.loop.p)
    change = share * (behind.loop.unknowns - before.loop.unknowns)
    return solve(before.loop.moved(change, p - before.loop.p), FixedLoad(p)).loop
