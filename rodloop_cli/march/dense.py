"""The motion between the ends of a step.

Positions and angles integrate the polynomial through the rates at the start and the stages, one degree above the
stages' own; velocities are that polynomial; forces and moments interpolate the stages, and the start only where it is
as good: in Radau IIA the constraint's forces there are of lower order.
"""

from functools import cache, cached_property
from typing import Self

import numpy as np

from rodloop_cli.march.state import Step
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.numerics.interpolation import StepWeights, step_weights
from rodloop_cli.physics.equations import NODAL, THETA


class Shapes:
    """The loop at ``times`` (k,) within a step, at the Gauss points and, last, at the right end of each cell.

    Whatever is not asked for is not computed.
    """

    def __init__(self, step: Step, times: Array, weights: StepWeights | None = None) -> None:
        """``weights``: those at the times, if they are at hand."""
        self._step, self.times = step, times
        self._weights = weights or step_weights(tuple(step.nodes.tolist()), fractions(step, times))

    @classmethod
    def inside(cls, step: Step, places: tuple[float, ...]) -> Self:
        """At ``places`` (k,) that are the same in every step, from its start (0) to its end (1)."""
        weights = _kept_weights(tuple(step.nodes.tolist()), places)
        return cls(step, step.start.time + step.size * np.array(places), weights)

    @cached_property
    def tangent(self) -> Array:
        """(2, k, n, m) at the Gauss points alone; does not need the positions."""
        return self._step.start.equations.tangent(self._moved)

    @cached_property
    def position(self) -> Array:
        """(2, k, n, m + 1)."""
        return self._step.start.equations.position(self._moved, self.tangent)

    @cached_property
    def theta(self) -> Array:
        """(k, n, m + 1)."""
        moved = self._moved
        theta = np.empty((*moved.shape[:-1], moved.shape[-1] - NODAL + 1))
        theta[..., :-1] = moved[..., NODAL:]
        theta[:, :-1, -1] = moved[:, 1:, THETA]
        theta[:, -1, -1] = moved[:, 0, THETA] + 2 * np.pi
        return theta

    @cached_property
    def velocity(self) -> Array:
        """(2, k, n, m + 1)."""
        step = self._step
        return _combined(self._weights.values, step.start.velocity, step.fields.velocity)

    @cached_property
    def force(self) -> Array:
        """(2, k, n, m + 1)."""
        step = self._step
        if step.moment_at_start is None:
            return _weighted(self._weights.stages, step.fields.force)
        return _combined(self._weights.values, step.start.force, step.fields.force)

    @cached_property
    def moment(self) -> Array:
        """(k, n, m + 1)."""
        step = self._step
        if step.moment_at_start is None:
            return _weighted(self._weights.stages, step.fields.moment)
        return _combined(self._weights.values, step.moment_at_start, step.fields.moment)

    @cached_property
    def spin(self) -> Array:
        """θ_t (k, n, m) at the Gauss points."""
        step = self._step
        return _combined(self._weights.values, step.start.rates[:, NODAL:], step.rates[..., NODAL:])

    @cached_property
    def _moved(self) -> Array:
        """(k, n, 6 + m): positions and angles among the unknowns; the rest has no meaning."""
        step = self._step
        moved = _combined(step.size * self._weights.integrals, step.start.rates, step.rates)
        moved += step.start.unknowns
        return moved


@cache
def _kept_weights(stages: tuple[float, ...], places: tuple[float, ...]) -> StepWeights:
    return step_weights(stages, np.array(places))


def fractions(step: Step, times: Array) -> Array:
    """(k,): where times within the step, but for round-off, lie between its start (0) and its end (1)."""
    return np.minimum(np.maximum((times - step.start.time) / step.size, 0.0), 1.0)


def _combined(weights: Array, start: Array, stages: Array) -> Array:
    """(…, k, n, i): sums of values at the start (…, n, i) and the stages (…, s, n, i), with weights (k, 1 + s)."""
    sums = _weighted(weights[:, 1:], stages)
    sums += weights[:, 0, None, None] * start[..., None, :, :]
    return sums


def _weighted(weights: Array, stages: Array) -> Array:
    """(…, k, n, i): sums of values at the stages (…, s, n, i) with weights (k, s)."""
    *parts, s, cells, points = stages.shape
    sums: Array = (weights @ stages.reshape(*parts, s, cells * points)).reshape(*parts, len(weights), cells, points)
    return sums
