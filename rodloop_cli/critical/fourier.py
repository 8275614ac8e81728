"""The paper's own computation of p(α), Appendix D: a sine series for the tangent angle, minimised by sequential
quadratic programming.

    θ(s) = s + Σ_{m=1}^{M} a_m sin(m s/2)                                                                      (D.1)

with the bending energy ½ ∮ b θ'² ds as objective and closure and area as constraints. At a stiffness junction θ' jumps,
the series does not: it converges like 1/M there, which is why the boxes are the default. All gradients are exact.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import minimize

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.numerics.gauss import Array, GaussRule
from rodloop_cli.physics.rod import Mesh, Rod
from rodloop_cli.statics.loaded import mesh_of

DEFAULT_MODES = 40
"""As many as the paper's figures can have had: their value for ratio 12.8 lies near M = 40."""

ACCURACY = 1e-14
MOST_ITERATIONS = 300
FEASIBLE, STATIONARY = 1e-7, 1e-4
FIRST_SHARE, STEPS = 0.1, 4
OVAL = 4
"""The term sin 2s, by which a uniform loop, whose circle is a stationary point at every area constraint, is led to
buckle.
"""


@dataclass(frozen=True, eq=False)
class SineSeries:
    """The functionals of the coefficients a (M,), by quadrature on cells that respect the junctions."""

    mesh: Mesh
    rule: GaussRule
    modes: int

    @cached_property
    def points(self) -> Array:
        """(Q,): arclengths of the quadrature points."""
        return self.mesh.points(self.rule.points).ravel()

    @cached_property
    def weights(self) -> Array:
        """(Q,): quadrature weights."""
        weights: Array = (self.mesh.lengths[:, None] * self.rule.weights).ravel()
        return weights

    @cached_property
    def sines(self) -> Array:
        """(Q, M): sin(m s/2), the derivative of θ by a."""
        return np.sin(np.outer(self.points, np.arange(1, self.modes + 1) / 2))

    @cached_property
    def quadratic(self) -> tuple[Array, Array]:
        """H (M, M) and g (M,) of the bending energy ½ aᵀH a + gᵀa, up to a constant."""
        half = np.arange(1, self.modes + 1) / 2
        slopes = half * np.cos(np.outer(self.points, half))
        stiffness = self.weights * np.repeat(self.mesh.stiffness, self.rule.m)
        return slopes.T @ (stiffness[:, None] * slopes), slopes.T @ stiffness

    @cached_property
    def circulation(self) -> Array:
        """(Q, Q): w ∫ - (w ∫)ᵀ, with which the area of the curve from its tangents (c, s) is ½ sᵀ (w ∫) c - ½ cᵀ (w ∫)
        s.
        """
        inside = np.kron(np.eye(self.mesh.cells), self.rule.to_points.T) * np.repeat(self.mesh.lengths, self.rule.m)
        cell = np.repeat(np.arange(self.mesh.cells), self.rule.m)
        integral = inside + np.where(cell[:, None] > cell[None, :], self.weights, 0.0)
        weighted = self.weights[:, None] * integral
        circulation: Array = weighted - weighted.T
        return circulation

    def energy(self, a: Array) -> float:
        quadratic, linear = self.quadratic
        return float(a @ quadratic @ a / 2 + linear @ a)

    def energy_slope(self, a: Array) -> Array:
        quadratic, linear = self.quadratic
        return quadratic @ a + linear

    def gap(self, a: Array) -> Array:
        """(2,): ∮ cos θ ds and ∮ sin θ ds."""
        theta = self.points + self.sines @ a
        return np.array([self.weights @ np.cos(theta), self.weights @ np.sin(theta)])

    def gap_slope(self, a: Array) -> Array:
        """(2, M)."""
        theta = self.points + self.sines @ a
        slope: Array = (np.stack([-np.sin(theta), np.cos(theta)]) * self.weights) @ self.sines
        return slope

    def area(self, a: Array) -> float:
        theta = self.points + self.sines @ a
        return float(np.sin(theta) @ self.circulation @ np.cos(theta)) / 2

    def area_slope(self, a: Array) -> Array:
        """(M,)."""
        theta = self.points + self.sines @ a
        cosine, sine = np.cos(theta), np.sin(theta)
        by_angle = cosine * (self.circulation @ cosine) + sine * (self.circulation @ sine)
        return self.sines.T @ by_angle / 2


def fourier_pressure(rod: Rod, alpha: float, modes: int = DEFAULT_MODES) -> float:
    """p(α) by Appendix D with ``modes`` sine modes. Raises ConvergenceError if the minimisation fails.

    The area is reduced in steps, each starting from the last, so that the minimiser keeps to its branch.
    """
    series = SineSeries(*mesh_of(rod, max(12, modes)), modes)
    shape = _minimum(series, np.zeros(modes), None)[0]
    unloaded = series.area(shape)
    if not rod.has_stiffness_contrast and modes >= OVAL:
        shape[OVAL - 1] += FIRST_SHARE * abs(1 - alpha) ** 0.5
    pressure = 0.0
    for share in np.geomspace(FIRST_SHARE, 1.0, STEPS):
        shape, pressure = _minimum(series, shape, (1 - share * (1 - alpha)) * unloaded)
    return pressure


def _minimum(series: SineSeries, guess: Array, area: float | None) -> tuple[Array, float]:
    """The coefficients of least energy, and the multiplier of the area (where none is given, it means nothing)."""
    constraints: list[Any] = [{"type": "eq", "fun": series.gap, "jac": series.gap_slope}]
    if area is not None:
        constraints.append({"type": "eq", "fun": lambda a: series.area(a) - area, "jac": series.area_slope})
    found: Any = minimize(
        series.energy,
        guess,
        jac=series.energy_slope,
        constraints=constraints,
        method="SLSQP",
        options={"ftol": ACCURACY, "maxiter": MOST_ITERATIONS},
    )
    shape = np.asarray(found.x)
    multipliers, uphill = _multipliers(series, shape, np.vstack([item["jac"](shape) for item in constraints]))
    missed = max(float(np.abs(item["fun"](shape)).max()) for item in constraints)
    # SLSQP's own verdict is about its last step; whether it got there is seen in the conditions of a minimum.
    if missed > FEASIBLE or uphill > STATIONARY:
        raise ConvergenceError(f"the sine series with {series.modes} modes was not minimised: {found.message}")
    return shape, float(multipliers[-1])


def _multipliers(series: SineSeries, shape: Array, slopes: Array) -> tuple[Array, float]:
    """Multipliers of the constraints with these slopes (c, M), and what of the energy's slope they do not balance."""
    slope = series.energy_slope(shape)
    multipliers = np.asarray(np.linalg.lstsq(slopes.T, -slope, rcond=None)[0], dtype=np.float64)
    return multipliers, float(np.abs(slope + slopes.T @ multipliers).max())
