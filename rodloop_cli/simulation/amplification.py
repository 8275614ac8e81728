"""Buckling waves that grow out of errors: how far a run has amplified what nobody asked for.

A segment under the compression N buckles in waves that grow e^(ωt)-fold. The tolerance refers to the departure from
the shape at t = 0, so errors that grow with it do no harm; waves that grow faster than it come out of errors.
"""

from math import exp, log, sqrt

import numpy as np

from rodloop_cli.march.state import Step
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import Load
from rodloop_cli.physics.rod import Rod, Segment

SUSPICIOUS = 5e4
"""Excess of amplification from which shapes may be off by many tol.

Of 243 random cases 9 exceed it, among them four of the five that are off by more than 5 tol; see docs/stability.md.
The homogeneous loop at p = 3.8 has 7e3 at t = 9.6, when it is round again."""


class Amplification:
    """Adds up the growth of the fastest wave of every segment.

    logarithms: (segments,) of its growth since t = 0;  excess: the largest of it, over that of the departure.
    """

    def __init__(self, rod: Rod, load: Load) -> None:
        self._segments, self._drag = rod.segments, load.zeta_perp
        self.logarithms = np.zeros(len(rod.segments))
        self._largest = 0.0

    @property
    def excess(self) -> float:
        """How many times more the fastest wave has grown than the departure."""
        return exp(min(self._largest, 700.0))

    def watch(self, step: Step, departed: float) -> None:
        """Take a step; ``departed`` is the departure at its end over that at t = 0."""
        compression = _compression(step, len(self._segments))
        rates = [growth_rate(s, self._drag, n) for s, n in zip(self._segments, compression, strict=True)]
        self.logarithms += step.size * np.array(rates)
        self._largest = max(self._largest, float(self.logarithms.max()) - log(departed))

    def memory(self) -> Array:
        """What a continued run needs."""
        return np.array([*self.logarithms, self._largest])

    def restore(self, memory: Array) -> None:
        """Go on where ``memory`` was taken."""
        self.logarithms, self._largest = memory[:-1].copy(), float(memory[-1])


def _compression(step: Step, segments: int) -> Array:
    """(segments,): minus the mean axial force at the end of a step."""
    mesh, weights = step.start.equations.mesh, step.start.equations.rule.weights
    axial = (step.fields.force[:, -1, :, :-1] * step.fields.tangent[:, -1]).sum(axis=0)
    in_cells = (axial @ weights) * mesh.lengths
    means: Array = -np.bincount(mesh.segment, in_cells, segments) / np.bincount(mesh.segment, mesh.lengths, segments)
    return means


def growth_rate(segment: Segment, drag: float, compression: float) -> float:
    """ω of the fastest wave of a circle of this segment's rod: Eq. (17) with the compression in place of p, any
    n >= 2, and normal drag.
    """
    load = compression / segment.stiffness
    squared = max(4.0, (load + 3) / 2)
    push = segment.stiffness * squared * (squared - 1) / (squared + 1) * (load + 1 - squared)
    if push <= 0:
        return 0.0
    return (sqrt(drag**2 + 4 * segment.density * push) - drag) / (2 * segment.density)
