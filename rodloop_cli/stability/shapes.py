"""Shapes of small motions on output points, and how many lobes they have."""

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.numerics.gauss import Array, lagrange_derivative
from rodloop_cli.physics.equations import NODAL, THETA
from rodloop_cli.physics.lobes import count_lobes
from rodloop_cli.physics.sampling import Sampler
from rodloop_cli.stability.spectrum import Eigenmotion
from rodloop_cli.statics.loaded import Loaded

OUTPUT_POINTS = 200

Samples = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Mode:
    """A growth rate λ and its shape at S points of arclength, complex where λ is, its largest displacement real and 1.

    displacement: (2, S);  turning, curvature: (S,) changes of θ and of θ';  lobes: crests of the change of curvature.
    """

    rate: complex
    displacement: Samples
    turning: Samples
    curvature: Samples
    lobes: int


def output_arclengths(points: int = OUTPUT_POINTS) -> Array:
    """(S,): uniform in [0, 2π)."""
    return np.linspace(0.0, 2 * pi, points, endpoint=False)


def sampled(loop: Loaded, motion: Eigenmotion, s: Array) -> Mode:
    """The shape of a small motion about ``loop`` at arclengths s (S,)."""
    sampler: Callable[[Samples], Samples] = Sampler(loop.equations.mesh, loop.equations.rule, s)
    unknowns = motion.unknowns
    displacement = sampler(_of_parts(loop.displacement, unknowns))
    turning = _with_ends(unknowns)
    curvature = sampler(_slope(loop, turning))
    factor = _phase(displacement)
    curvature = factor * curvature
    # Either sign is the same motion: the stronger bend is taken as the crest.
    sign = 1.0 if curvature.real.max() >= -curvature.real.min() else -1.0
    return Mode(
        motion.rate,
        sign * factor * displacement,
        sign * factor * sampler(turning),
        sign * curvature,
        count_lobes(sign * curvature.real / np.abs(curvature.real).max()),
    )


def _of_parts(linear: Any, values: Samples) -> Samples:
    """A real linear function of complex values."""
    if not np.iscomplexobj(values):
        return np.asarray(linear(values))
    return np.asarray(linear(values.real) + 1j * linear(values.imag))


def _with_ends(unknowns: Samples) -> Samples:
    """(n, m + 1): change of θ at the Gauss points and the right ends."""
    ends = np.roll(unknowns[:, THETA], -1)[:, None]
    return np.concatenate([unknowns[:, NODAL:], ends], axis=1)


def _slope(loop: Loaded, values: Samples) -> Samples:
    """(n, m + 1): derivative by the arclength inside each cell of values (n, m + 1) at the Gauss points and right ends.
    (n, m + 1): derivative by the arclength inside each cell of values (n, m + 1) at the Gauss points and right ends.
    """
    nodes = np.concatenate([[0.0], loop.equations.rule.points, [1.0]])
    derivative = lagrange_derivative(nodes, nodes[1:])
    left = np.roll(values[:, -1:], 1, axis=0)
    return np.concatenate([left, values], axis=1) @ derivative.T / loop.equations.mesh.lengths[:, None]


def _phase(displacement: Samples) -> complex:
    """The factor that makes the largest displacement real and 1."""
    sizes = np.sqrt((np.abs(displacement) ** 2).sum(axis=0))
    largest = displacement[:, int(sizes.argmax())]
    pivot = largest[int(np.abs(largest).argmax())]
    return complex(np.conj(pivot) / abs(pivot) / sizes.max())
