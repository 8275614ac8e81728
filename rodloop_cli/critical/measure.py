"""The paper's measure of the critical pressure, Section 5.1: p(α), the multiplier of least bending energy at area α A0.

The loop of least energy is followed from α = 1 on: along the branch of the unloaded loop, and where that one ceases to
be a minimum at its area, along the branch that crosses it there. A minimiser started anew for every α may land on
another branch instead.
"""

import math
from dataclasses import dataclass
from math import pi

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.stability.threshold import neutral_directions
from rodloop_cli.stability.watch import Watched, follow_watched, interpolated
from rodloop_cli.statics.branch import BranchPoint
from rodloop_cli.statics.loaded import Loaded
from rodloop_cli.statics.newton import FixedArea, solve
from rodloop_cli.statics.switching import crossing_branches

HIGHEST_LOAD = 1e3
"""A branch whose area has not reached its target at this load will not."""

FIRST_AMPLITUDE = 0.05
"""First step on a crossing branch, as turning of the rod (root mean square)."""

WIDEST_GAP, CLOSER = 1e-3, 10.0
"""The limit is extrapolated from this 1 - α, or a smaller one that is asked for, and a tenth of it."""

UNRESPONSIVE = 1e-14
"""Relative change of area with the load that is round-off: the loop is a circle as far as double precision can tell."""


@dataclass(frozen=True, eq=False)
class Bracket:
    """Two equilibria of one branch with the wanted area between theirs; ``quadratic`` if the area is level at the
    first.
    """

    before: Loaded
    behind: Loaded
    quadratic: bool

    def at(self, area: float) -> Loaded:
        """The equilibrium with this area. Raises ConvergenceError if it is not found."""
        share = (area - self.before.area) / (self.behind.area - self.before.area)
        share = share**0.5 if self.quadratic else share
        change = share * (self.behind.unknowns - self.before.unknowns)
        guess = self.before.moved(change, share**2 * (self.behind.p - self.before.p))
        return solve(guess, FixedArea(area)).loop


def least_energy(start: Loaded, alpha: float) -> Loaded:
    """The loop of least bending energy at area α A0, A0 that of the unloaded loop ``start``; its load is p(α).

    α > 1 asks for a load that inflates the loop (p < 0). Raises ConvergenceError if no equilibrium on the way has that
    area.
    """
    return bracket_of(start, alpha).at(alpha * start.area)


def bracket_of(start: Loaded, alpha: float) -> Bracket:
    """Equilibria around the wanted area on the branch of least energy. Raises ConvergenceError if there are none."""
    target = alpha * start.area
    if alpha == 1 or target >= pi:
        raise ConvergenceError(f"no loop encloses {alpha:g} times the area of the unloaded one under a load of its own")
    found = _along(Watched(BranchPoint.first(start, rising=alpha < 1)), target)
    if isinstance(found, Bracket):
        return found
    switched = _lower(found, target)
    first = switched.step(FIRST_AMPLITUDE)
    if first is None:
        raise ConvergenceError(f"the branch that crosses at p = {found.p:.6g} cannot be entered")
    if _passed(found, first[0].loop, target):
        return Bracket(found, first[0].loop, quadratic=True)
    further = _along(Watched(first[0]), target)
    if isinstance(further, Bracket):
        return further
    raise ConvergenceError(f"the loop of least energy branches twice, at p = {found.p:.6g} and {further.p:.6g}")


def _along(start: Watched, target: float) -> Bracket | Loaded:
    """Follow a branch to the area ``target``, or to where it ceases to be of least energy at its area."""
    before = start
    for here in follow_watched(start):
        if _passed(before.loop, here.loop, target):
            return Bracket(before.loop, here.loop, quadratic=False)
        if before.is_minimum and not here.is_minimum:
            return interpolated(before, here, before.squares_at_fixed_area[0], here.squares_at_fixed_area[0])
        if abs(here.loop.p) > HIGHEST_LOAD:
            break
        before = here
    raise ConvergenceError(f"no equilibrium with area {target:.6g} up to p = {before.loop.p:.6g}")


def _passed(before: Loaded, here: Loaded, target: float) -> bool:
    return (before.area - target) * (here.area - target) <= 0 and before.area != here.area


def _lower(crossing: Loaded, target: float) -> BranchPoint:
    """The half of the crossing branch whose area moves towards the target; of two, the one with less energy."""
    halves = crossing_branches(crossing, neutral_directions(crossing))
    trials = [(half, half.ahead(FIRST_AMPLITUDE)) for half in halves]
    side = np.sign(target - crossing.area)
    towards = [(loop.bending_energy, i) for i, (_, loop) in enumerate(trials) if side * (loop.area - crossing.area) > 0]
    if not towards:
        raise ConvergenceError(f"the branch that crosses at p = {crossing.p:.6g} leads away from the area asked for")
    return trials[min(towards)[1]][0]


def limit(start: Loaded, alpha: float) -> float:
    """lim p(α) for α → 1, from the side of ``alpha``.

    Zero for a loop whose area answers to the load at once, by `compressibility`: p(α) then goes to zero with 1 - α.
    The circle's area is the largest there is and does not; the limit is then extrapolated linearly in 1 - α.
    """
    if compressibility(start) > UNRESPONSIVE:
        return 0.0
    gap = math.copysign(min(abs(1 - alpha), WIDEST_GAP), 1 - alpha)
    bracket = bracket_of(start, 1 - gap)
    far, near = (bracket.at((1 - g) * start.area).p for g in (gap, gap / CLOSER))
    return near - (far - near) / (CLOSER - 1)


def compressibility(start: Loaded) -> float:
    """-(dA/dp)/A of the unloaded loop: 1 - α = compressibility · p for small loads."""
    tangent = BranchPoint.first(start).tangent
    change = float((start.area_row * tangent.unknowns).sum())
    return -change / tangent.p / start.area
