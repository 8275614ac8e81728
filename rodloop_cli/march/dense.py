"""The motion between the ends of a step.

Positions and angles integrate the polynomial through the rates at the start and the stages, one degree above the
stages' own; velocities are that polynomial; forces and moments interpolate the stages alone, the constraint's forces
at the start being of lower order.
"""

from functools import cached_property

import numpy as np

from rodloop_cli.march.state import Step
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.numerics.interpolation import interpolation, series
from rodloop_cli.physics.equations import NODAL, THETA


class Shapes:
    """The loop at ``times`` (k,) within a step, at the Gauss points and, last, at the right end of each cell.

    Whatever is not asked for is not computed.
    """

    def __init__(self, step: Step, times: Array) -> None:
        self.times = times
        self._step = step
        self._series = series(fractions(step, times), len(step.nodes) + 2)
        nodes = tuple(step.nodes.tolist())
        self._by_stages, self._by_rates = interpolation(nodes), interpolation((0.0, *nodes))

    @property
    def tangent(self) -> Array:
        """(2, k, n, m) at the Gauss points alone."""
        return self._shape[0]

    @property
    def position(self) -> Array:
        """(2, k, n, m + 1)."""
        return self._shape[1]

    @cached_property
    def theta(self) -> Array:
        """(k, n, m + 1)."""
        angles, nodal = self._moved[..., NODAL:], self._moved[..., THETA]
        theta = np.empty((*angles.shape[:-1], angles.shape[-1] + 1))
        theta[..., :-1] = angles
        theta[:, :-1, -1] = nodal[:, 1:]
        theta[:, -1, -1] = nodal[:, 0] + 2 * np.pi
        return theta

    @cached_property
    def velocity(self) -> Array:
        """(2, k, n, m + 1)."""
        return self._from_rates(self._step.start.velocity[:, None], self._step.fields.velocity)

    @cached_property
    def force(self) -> Array:
        """(2, k, n, m + 1)."""
        return _weighted(self._stage_weights, self._step.fields.force)

    @cached_property
    def moment(self) -> Array:
        """(k, n, m + 1)."""
        moment: Array = _weighted(self._stage_weights, self._step.fields.moment[None])[0]
        return moment

    @cached_property
    def spin(self) -> Array:
        """θ_t (k, n, m) at the Gauss points."""
        step = self._step
        spin: Array = self._from_rates(step.start.rates[None, None, :, NODAL:], step.rates[None, ..., NODAL:])[0]
        return spin

    @cached_property
    def _shape(self) -> tuple[Array, Array]:
        return self._step.start.equations.shape(self._moved)

    @cached_property
    def _moved(self) -> Array:
        """(k, n, 6 + m): positions and angles among the unknowns; the rest has no meaning."""
        step = self._step
        weights = self._series @ (step.size * self._by_rates.integrals)
        moved: Array = _weighted(weights[:, 1:], step.rates[None])[0]
        moved += weights[:, 0, None, None] * step.start.rates
        moved += step.start.unknowns
        return moved

    def _from_rates(self, start: Array, stages: Array) -> Array:
        """(c, k, …): the polynomial through the values at the start (c, 1, …) and at the stages (c, s, …)."""
        values = _weighted(self._rate_weights[:, 1:], stages)
        values += self._rate_weights[:, 0, None, None] * start
        return values

    @cached_property
    def _rate_weights(self) -> Array:
        weights: Array = self._series[:, :-1] @ self._by_rates.values
        return weights

    @cached_property
    def _stage_weights(self) -> Array:
        weights: Array = self._series[:, :-2] @ self._by_stages.values
        return weights


def fractions(step: Step, times: Array) -> Array:
    """(k,): where times within the step, but for round-off, lie between its start (0) and its end (1)."""
    return np.minimum(np.maximum((times - step.start.time) / step.size, 0.0), 1.0)


def _weighted(weights: Array, stages: Array) -> Array:
    """(c, k, …): sums of values at the stages (c, s, …) with weights (k, s)."""
    flat = stages.reshape(*stages.shape[:2], -1)
    sums: Array = (weights @ flat).reshape(len(stages), len(weights), *stages.shape[2:])
    return sums
