"""First guess of a step's stages: the last step's polynomial, as far as it can be trusted.

Extrapolating a polynomial of full degree over a longer step blows up whatever is not smooth (the bending waves that
leave a stiffness junction at t = 0+). So it is expanded about the end of the last step, and cut where its terms stop
shrinking; position and velocity at the start of the step are then always met.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from rodloop_cli.march.state import State, Step
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import FORCE

SHRINKING = 0.7
"""A Taylor term is used if it is smaller than this times the term before."""


class Past(NamedTuple):
    """What the predictor remembers of the last step (BDF2: of the last two as one).

    nodes: (s,);  unknowns: (s + 1, n, 6 + m) at its start and stages;  force: (2, s, n, m + 1) at its stages.
    """

    size: float
    nodes: Array
    unknowns: Array
    force: Array

    @classmethod
    def of(cls, step: Step) -> "Past":
        """The memory of one step."""
        unknowns = np.concatenate([step.start.unknowns[None], step.unknowns])
        return cls(step.size, step.nodes, unknowns, step.fields.force)


class Guess(NamedTuple):
    """Guess of the stages of a step: unknowns (s, n, 6 + m), force (2, s, n, m + 1)."""

    unknowns: Array
    force: Array


def predict(state: State, last: Past | None, nodes: Array, size: float) -> Guess:
    """The stages at times ``nodes`` of a step of length ``size``."""
    if last is None:
        unknowns = state.unknowns + (size * nodes)[:, None, None] * state.rates
        return Guess(unknowns, np.repeat(state.force[:, None], len(nodes), axis=1))
    ratio = size / last.size
    unknowns = _continued((0.0, *last.nodes.tolist()), last.unknowns, ratio, nodes)
    # The forces at the start of the last step are not those of its stages: they are the constraint's, of lower order.
    force = _continued(tuple(last.nodes.tolist()), last.force, ratio, nodes)
    unknowns[:, 0, FORCE], unknowns[:, 1:, FORCE] = force[..., -1, -1].T, force[..., :-1, -1].transpose(1, 2, 0)
    return Guess(unknowns, force)


def _continued(known: tuple[float, ...], values: Array, ratio: float, nodes: Array) -> Array:
    """Taylor polynomial about node 1 of the interpolant of ``values`` (..., known, n, points), at the ``nodes`` of a
    step ``ratio`` times as long.
    """
    *parts, _, cells, points = values.shape
    powers = ratio ** np.arange(len(known))
    taylor = _taylor_from_samples(known) * powers[:, None]
    coefficients = taylor @ values.reshape(*parts, len(known), -1)
    largest = np.abs(coefficients).max(axis=-1).reshape(-1, len(known)).max(axis=0).tolist()
    terms = min(2, len(known))
    while terms < len(known) and largest[terms] < SHRINKING * largest[terms - 1]:
        terms += 1
    continued = _powers(tuple(nodes.tolist()), terms) @ coefficients[..., :terms, :]
    return continued.reshape(*parts, len(nodes), cells, points)


@cache
def _taylor_from_samples(known: tuple[float, ...]) -> Array:
    return np.linalg.inv(np.vander(np.array(known) - 1, increasing=True))


@cache
def _powers(nodes: tuple[float, ...], terms: int) -> Array:
    return np.vander(np.array(nodes), terms, increasing=True)
