"""Shapes of the unloaded loop: tangent angle along the arclength, and its perturbation.

A base shape displaced along its outward normal by δ(s) turns its tangent by -atan2(δ', 1 + κδ) and stretches by
hypot(1 + κδ, δ'). The stretch is taken out by a new arclength, so that the perturbed shape is a state of the
inextensible rod: a perturbation that keeps the parameter would be thrown back by the constraint in the first time
step, with velocities ε/Δt.

In the turning, κ is 1, its mean: exact for the circle. Where the curvature of the base jumps at a stiffness junction,
the tangent of the displaced curve would jump too, by O(ε²), and a kink is no state of an elastic rod.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rodloop_cli.numerics.gauss import Array, gauss_rule
from rodloop_cli.physics.rod import LENGTH, Rod

QUADRATURE_POINTS = 16
CELLS_PER_WAVE = 2

CONVERGED = 1e-9
"""A step of Newton's method for the old arclength after which what is left, its square, is round-off."""

MOST_STEPS = 12


@dataclass(frozen=True)
class Wave:
    """One term amplitude·cos(mode·s - phase) of the outward displacement."""

    mode: int
    amplitude: float
    phase: float = 0.0


def random_waves(amplitude: float, modes: tuple[int, int], seed: int) -> tuple[Wave, ...]:
    """Normal coefficients and uniform phases over the inclusive range of modes, scaled to max|δ| = amplitude."""
    generator = np.random.default_rng(seed)
    numbers = np.arange(modes[0], modes[1] + 1)
    coefficients = generator.normal(size=len(numbers))
    phases = generator.uniform(0.0, 2 * np.pi, size=len(numbers))
    waves = tuple(Wave(int(n), float(a), float(b)) for n, a, b in zip(numbers, coefficients, phases, strict=True))
    fine = np.linspace(0, LENGTH, 64 * modes[1], endpoint=False)
    scale = amplitude / np.abs(displacement(waves, fine)).max()
    return tuple(Wave(w.mode, w.amplitude * float(scale), w.phase) for w in waves)


def displacement(waves: tuple[Wave, ...], s: Array) -> Array:
    """δ(s), outward."""
    return sum((w.amplitude * np.cos(w.mode * s - w.phase) for w in waves), np.zeros_like(s))


def displacement_and_slope(waves: tuple[Wave, ...], s: Array) -> tuple[Array, Array]:
    """δ(s) and δ'(s)."""
    delta, slope = np.zeros_like(s), np.zeros_like(s)
    for wave in waves:
        phase = wave.mode * s
        phase -= wave.phase
        delta += wave.amplitude * np.cos(phase)
        slope -= wave.mode * wave.amplitude * np.sin(phase)
    return delta, slope


def slope_change(waves: tuple[Wave, ...], s: Array) -> Array:
    """δ''(s)."""
    return sum((-(w.mode**2) * w.amplitude * np.cos(w.mode * s - w.phase) for w in waves), np.zeros_like(s))


@dataclass(frozen=True)
class Shape:
    """A closed shape of length 2π, smooth between ``breaks``, which include 0 and 2π.

    along: tangent angle and curvature at s of any dimensions;  centre: of the material points, each weighted by
    arclength.
    """

    along: Callable[[Array], tuple[Array, Array]]
    breaks: Array
    centre: Array


def circle() -> Shape:
    """x = sin s, y = -cos s."""
    return Shape(lambda s: (s, np.ones_like(s)), np.array([0.0, LENGTH]), np.zeros(2))


def perturbed(base: Shape, waves: tuple[Wave, ...], rod: Rod) -> Shape:
    """The base displaced by the waves and given a new arclength.

    A circle is scaled as a whole, and its arclength counted from s = 0. Where the base has kinks of curvature at
    stiffness junctions, each segment is scaled by itself, so that the kinks stay on the junctions (the gap that this
    opens is closed when the shape is laid on a mesh).
    """
    if not waves:
        return base
    ends = rod.ends if rod.has_stiffness_contrast else np.array([LENGTH])
    arclength = _NewArclength(base, waves, ends)

    def along(s: Array) -> tuple[Array, Array]:
        old, rate = arclength.old(s)
        theta, curvature = base.along(old)
        delta, outward = displacement_and_slope(waves, old)
        forward = 1 + delta
        turning = (forward * slope_change(waves, old) - outward**2) / (forward**2 + outward**2)
        return theta - np.arctan2(outward, forward), (curvature - turning) * rate

    return Shape(along, arclength.new(base.breaks), _centre(base, waves, arclength))


class _NewArclength:
    """The increasing map from old to new arclength, and its inverse."""

    def __init__(self, base: Shape, waves: tuple[Wave, ...], ends: Array) -> None:
        self._base, self._waves = base, waves
        cells = CELLS_PER_WAVE * max(wave.mode for wave in waves)
        uniform = np.linspace(0, LENGTH, cells + 1)
        self._edges = np.unique(np.concatenate([uniform, base.breaks, [0.0], ends]))
        self._rule = gauss_rule(QUADRATURE_POINTS)
        self._places = np.append(self._rule.points, 1.0)
        lengths = self._integral(self._edges[:-1], self._edges[1:])
        self._stretched = np.concatenate([[0.0], np.cumsum(lengths)])
        starts = np.concatenate([[0.0], ends[:-1]])
        at = np.searchsorted(self._edges, np.concatenate([[0.0], ends]))
        scale = (ends - starts) / np.diff(self._stretched[at])
        self._scale = scale[np.searchsorted(ends, (self._edges[:-1] + self._edges[1:]) / 2)]
        self._new_edges = np.concatenate([[0.0], np.cumsum(lengths * self._scale)])

    def stretch(self, s: Array) -> Array:
        delta, slope = displacement_and_slope(self._waves, s)
        delta *= self._base.along(s)[1]
        delta += 1
        return np.hypot(delta, slope)

    def _integral(self, start: Array, end: Array) -> Array:
        return self._integral_and_end(start, end)[0]

    def _integral_and_end(self, start: Array, end: Array) -> tuple[Array, Array]:
        """Of the stretch, and its value at the end."""
        length = end - start
        stretch = self.stretch(start[..., None] + length[..., None] * self._places)
        integral: Array = length * (stretch[..., :-1] @ self._rule.weights)
        return integral, stretch[..., -1]

    def new(self, old: Array) -> Array:
        """New arclength of points of the base."""
        cell = np.clip(np.searchsorted(self._edges, old, side="right") - 1, 0, len(self._scale) - 1)
        inside = self._integral(self._edges[cell], old)
        mapped: Array = self._new_edges[cell] + self._scale[cell] * inside
        return mapped

    def old(self, new: Array) -> tuple[Array, Array]:
        """Points of the base that have this new arclength, by Newton's method inside a cell, and their rate of change
        with it.
        """
        cell = np.clip(np.searchsorted(self._new_edges, new, side="right") - 1, 0, len(self._scale) - 1)
        start, new_start, scale = self._edges[cell], self._new_edges[cell], self._scale[cell]
        old: Array = np.interp(new, self._new_edges, self._edges)
        for _ in range(MOST_STEPS):
            passed, stretch = self._integral_and_end(start, old)
            rate = 1 / (scale * stretch)
            step = (new - new_start - scale * passed) * rate
            old = old + step
            if np.abs(step).max() < CONVERGED:
                break
        return old, rate


def _centre(base: Shape, waves: tuple[Wave, ...], arclength: _NewArclength) -> Array:
    """Of the displaced circle about the circle's own centre; a loop with kinks keeps the centre of its base."""
    if len(base.breaks) > 2:
        return base.centre
    s = np.linspace(0, LENGTH, 64 * max(wave.mode for wave in waves), endpoint=False)
    radius = 1 + displacement(waves, s)
    weight = arclength.stretch(s)
    outward = np.stack([np.sin(s), -np.cos(s)])
    scale = LENGTH / (weight.mean() * LENGTH)
    centre: Array = scale * (outward * radius * weight).sum(axis=1) / weight.sum()
    return centre
