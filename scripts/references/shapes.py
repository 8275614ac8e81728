"""Initial shapes theta(s): the perturbed circle, and the equilibrium of an unloaded loop of uneven stiffness.

Nothing here is discretised on anybody's grid: both shapes can be evaluated at any arclength to about 1e-13.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import root

from .problem import PI2, Mode, Problem, Segment

Array = NDArray[np.float64]
Angle = Callable[[Array], Array]

SHOOTING_STEP = 0.05  # keeps DOP853's dense output at round-off


def initial_angle(problem: Problem) -> Angle:
    """Tangent angle at t = 0 as a function of arclength, continuous, theta(s + 2 pi) = theta(s) + 2 pi."""
    if len({s.stiffness for s in problem.segments}) == 1:
        return perturbed_circle(problem.perturbation)
    if problem.perturbation:
        raise ValueError("a perturbed loop of uneven stiffness is not among the references")
    return unloaded_equilibrium(problem.segments)


def perturbed_circle(modes: tuple[Mode, ...], points: int = 512) -> Angle:
    """Curve r(phi) = 1 + sum a cos(n phi - c), rescaled to length 2 pi and reparametrised by arclength.

    phi is measured counter-clockwise from the bottom; theta = phi - atan(r'/r); ds = sqrt(r^2 + r'^2) dphi is
    integrated as a Fourier series and inverted by Newton's method.
    """
    if not modes:
        return lambda s: np.asarray(s, float)

    def radius(phi: Array) -> tuple[Array, Array]:
        r, dr = np.ones_like(phi), np.zeros_like(phi)
        for m in modes:
            r += m.amplitude * np.cos(m.mode * phi - m.phase)
            dr -= m.amplitude * m.mode * np.sin(m.mode * phi - m.phase)
        return r, dr

    spectrum = np.fft.rfft(np.hypot(*radius(PI2 * np.arange(points) / points))) / points
    wave = np.arange(1, points // 4)
    mean, high = spectrum[0].real, spectrum[1 : points // 4] / (1j * wave)

    def arclength(phi: Array) -> Array:
        ripple = 2 * ((np.exp(1j * np.outer(phi, wave)) - 1) @ high).real
        along: Array = phi + ripple / mean
        return along

    def angle(s: Array) -> Array:
        s = np.asarray(s, float)
        phi = s.ravel().copy()
        for _ in range(8):
            phi -= (arclength(phi) - s.ravel()) * mean / np.hypot(*radius(phi))
        r, dr = radius(phi)
        return (phi - np.arctan2(dr, r)).reshape(s.shape)

    return angle


@lru_cache
def unloaded_equilibrium(segments: tuple[Segment, ...]) -> Angle:
    """Shape of least bending energy at p = 0, by shooting (theta' = M/b, M' = Fx sin theta - Fy cos theta).

    F is constant along the loop; the unknowns M(0), Fx, Fy close the curve. theta(0) = 0 fixes the rotation.
    """
    edges = Problem("", 0.0, (0.0,), segments).edges

    def slope(_s: float, z: Array, b: float, force: Array) -> Array:
        c, d = np.cos(z[0]), np.sin(z[0])
        return np.array([z[1] / b, force[0] * d - force[1] * c, c, d])

    def shoot(unknown: Array, dense: bool = False) -> list[Any]:
        z, parts = np.array([0.0, unknown[0], 0.0, 0.0]), []
        for left, right, segment in zip(edges[:-1], edges[1:], segments, strict=True):
            parts.append(
                solve_ivp(slope, (left, right), z, "DOP853", dense_output=dense, rtol=3e-14, atol=1e-15,
                          max_step=SHOOTING_STEP, args=(segment.stiffness, unknown[1:]))
            )  # fmt: skip
            z = parts[-1].y[:, -1]
        return parts

    def gap(unknown: Array) -> Array:
        z = shoot(unknown)[-1].y[:, -1]
        return np.array([z[0] - PI2, z[2], z[3]])

    mean = 1 / sum(s.fraction / s.stiffness for s in segments)
    found = root(gap, [mean, 0.0, 0.0], tol=1e-13)
    if np.abs(found.fun).max() > 1e-11:
        raise RuntimeError(f"the equilibrium shape does not close: gap {np.abs(found.fun).max():.1e}")
    parts = shoot(found.x, dense=True)

    def angle(s: Array) -> Array:
        s = np.asarray(s, float)
        where = np.clip(np.searchsorted(edges, s, side="right") - 1, 0, len(segments) - 1)
        out = np.empty(s.shape)
        for i, part in enumerate(parts):
            out[where == i] = part.sol(s[where == i])[0]
        return out

    return angle
