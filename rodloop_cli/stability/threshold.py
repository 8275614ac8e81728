"""Where the branch of equilibria from p = 0 loses its stability, and where the loop on it first touches itself."""

from contextlib import suppress
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.numerics.roots import bracketed_root
from rodloop_cli.physics.clearance import crossing_indicator
from rodloop_cli.physics.crossing import crosses_itself
from rodloop_cli.physics.sampling import Sampler
from rodloop_cli.stability.compliance import Compliance
from rodloop_cli.stability.shapes import output_arclengths
from rodloop_cli.stability.watch import Watched, follow_watched, interpolated, watch_shift
from rodloop_cli.statics.branch import BranchPoint
from rodloop_cli.statics.loaded import Loaded

Kind = Literal["bifurcation", "fold"]

OUTLINE_POINTS = 256
CONTACT_LOCATED = 1e-6
NULL = 1e-5
"""λ² below this (in units of the lowest of a uniform circle, 7.2) counts as zero at a located threshold."""

CHANGES_AREA = 1e-4
"""A neutral motion that changes the area by more than this, relative to the displacement, belongs to a fold."""


class Threshold(NamedTuple):
    """The first equilibrium of a branch that is not stable: its load, and what happens there."""

    p: float
    kind: Kind
    loop: Loaded


@dataclass(frozen=True, eq=False)
class Stability:
    """A branch from p = 0 up to its threshold, or to the end of the search.

    p, area, bending_energy, square: (K,) along the branch, square the largest λ²;  threshold: None if there is none up
    to the end; p_contact: load at which the loop on the branch first touches itself, None if it does not.
    """

    p: Array
    area: Array
    bending_energy: Array
    square: Array
    threshold: Threshold | None
    p_contact: float | None


def find_threshold(start: Loaded, p_max: float, *, until_contact: bool = False) -> Stability:
    """Follow the branch through the unloaded loop ``start`` to the load p_max of either sign.

    ``until_contact``: no further than to self-contact, beyond which the loop would pass through itself. The search ends
    early where the branch cannot be followed; the last ``p`` tells.
    """
    passed = [Watched(BranchPoint.first(start, rising=p_max > 0))]
    contact: float | None = None
    with suppress(ConvergenceError):
        for here in follow_watched(passed[0]):
            before = passed[-1]
            passed.append(here)
            if contact is None and touches_itself(here.loop):
                contact = _contact_between(before, here)
            if not here.is_stable:
                return _summed_up(passed, classified(_between(before, here)), contact, p_max)
            if abs(here.loop.p) >= abs(p_max) or (until_contact and contact is not None):
                break
    return _summed_up(passed, None, contact, p_max)


def _between(before: Watched, here: Watched) -> Loaded:
    return interpolated(before, here, float(before.squares[0]), float(here.squares[0]))


def classified(loop: Loaded) -> Threshold:
    """At a fold the neutral motion changes the area (the load could do work on it), at a bifurcation it does not."""
    direction = neutral_directions(loop)[0]
    displacement = loop.displacement(direction)
    change = abs(float((loop.area_row * direction).sum())) / float(np.abs(displacement).max())
    return Threshold(float(loop.p), "fold" if change > CHANGES_AREA else "bifurcation", loop)


def neutral_directions(loop: Loaded) -> list[Array]:
    """Changes of the unknowns (n, 6 + m) in the motions with λ² = 0 at a threshold; at least the one next to it."""
    compliance = Compliance(loop, watch_shift(loop))
    squares, vectors = compliance.eigenpairs
    neutral = [i for i in range(2) if abs(squares[i]) < NULL] or [int(np.abs(squares).argmin())]
    return [compliance.corrections_of(float(squares[i]), vectors[:, i]) for i in neutral]


def outline(loop: Loaded) -> Array:
    """(2, S): the centreline as a polygon."""
    sampler = Sampler(loop.equations.mesh, loop.equations.rule, output_arclengths(OUTLINE_POINTS))
    return sampler(loop.fields.position[:, 0])


def touches_itself(loop: Loaded) -> bool:
    return crosses_itself(*outline(loop))


def _contact_between(before: Watched, here: Watched) -> float:
    def clearance(distance: float) -> float:
        return crossing_indicator(*outline(before.point.ahead(distance)))

    length = here.point.distance - before.point.distance
    return before.point.ahead(bracketed_root(clearance, 0.0, length, CONTACT_LOCATED)).p


def _summed_up(passed: list[Watched], threshold: Threshold | None, contact: float | None, p_max: float) -> Stability:
    """What was found; the last step may have gone beyond p_max, what was found there does not count."""
    columns = [(w.loop.p, w.loop.area, w.loop.bending_energy, w.squares[0]) for w in passed]
    p, area, energy, square = np.array(columns).T
    if threshold is not None and abs(threshold.p) > abs(p_max):
        threshold = None
    if contact is not None and abs(contact) > abs(p_max):
        contact = None
    return Stability(p, area, energy, square, threshold, contact)
