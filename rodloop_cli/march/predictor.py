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
from rodloop_cli.physics.equations import FX, FY

SHRINKING = 0.7
"""A Taylor term is used if it is smaller than this times the term before."""


class Past(NamedTuple):
    """What the predictor remembers of the last step.

    nodes: (s,);  unknowns: (s + 1, n, 6 + m) at its start and stages.
    """

    size: float
    nodes: Array
    unknowns: Array

    @classmethod
    def of(cls, step: Step) -> "Past":
        """The memory of one step."""
        return cls(step.size, step.nodes, np.concatenate([step.start.unknowns[None], step.unknowns]))


def predict(state: State, last: Past | None, nodes: Array, size: float) -> Array:
    """(s, n, 6 + m): guess of the stages at times ``nodes`` of a step of length ``size``."""
    if last is None:
        guess: Array = state.unknowns + (size * nodes)[:, None, None] * state.rates
        return guess
    times = size / last.size * nodes
    guess = _continued(np.concatenate([[0.0], last.nodes]), last.unknowns, times)
    # The forces at the start of the last step are not those of its stages: they are the constraint's, of lower order.
    guess[..., FX : FY + 1] = _continued(last.nodes, last.unknowns[1:, :, FX : FY + 1], times)
    return guess


def _continued(nodes: Array, values: Array, times: Array) -> Array:
    """Taylor polynomial about node 1 of the interpolant of ``values``, at ``times`` behind it."""
    coefficients = _taylor_from_samples(tuple(nodes)) @ values.reshape(len(nodes), -1)
    sizes = np.abs(coefficients).max(axis=1) * times[-1] ** np.arange(len(nodes))
    terms = min(2, len(nodes))
    while terms < len(nodes) and sizes[terms] < SHRINKING * sizes[terms - 1]:
        terms += 1
    continued = np.vander(times, terms, increasing=True) @ coefficients[:terms]
    return continued.reshape(len(times), *values.shape[1:])


@cache
def _taylor_from_samples(nodes: tuple[float, ...]) -> Array:
    return np.linalg.inv(np.vander(np.array(nodes) - 1, increasing=True))
