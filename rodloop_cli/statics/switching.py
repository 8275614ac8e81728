"""Leaving a branch of equilibria where another one crosses it."""

import numpy as np

from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import THETA
from rodloop_cli.statics.branch import BranchPoint
from rodloop_cli.statics.loaded import Loaded
from rodloop_cli.statics.newton import Tangent

SYMMETRIC = 1e-9
"""Turnings of node 0 below this, in a direction normalised to a turning of 1, need no combination."""


def crossing_branches(loop: Loaded, neutral: list[Array]) -> tuple[BranchPoint, BranchPoint]:
    """The starts of the two halves of the branch that crosses at ``loop``, along the neutral motion(s) (n, 6 + m)
    there.

    A uniform loop has two neutral motions, cos ns and sin ns, and a whole circle of branches that differ by where the
    material lies: the one of sin ns is taken, whose halves are the two orientations of the buckled loop.
    """
    direction = neutral[0] if len(neutral) == 1 else _without_turn_at_start(*neutral)
    tangent = Tangent(direction, 0.0)
    tangent = tangent.scaled(tangent.along(loop, tangent) ** -0.5)
    return BranchPoint(loop, tangent), BranchPoint(loop, tangent.scaled(-1.0))


def _without_turn_at_start(one: Array, other: Array) -> Array:
    """The combination that leaves θ at s = 0 as it is."""
    here, there = one[0, THETA], other[0, THETA]
    if np.hypot(here, there) < SYMMETRIC * float(np.abs(one).max()):
        return one
    return np.asarray((there * one - here * other) / np.hypot(here, there))
