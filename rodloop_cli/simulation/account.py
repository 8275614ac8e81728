"""The energy account of a run: every energy at the stored times, and the residual that should be zero."""

from functools import cache

import numpy as np

from rodloop_cli.march.dense import Shapes, fractions
from rodloop_cli.march.state import Step
from rodloop_cli.numerics.gauss import Array, gauss_rule
from rodloop_cli.numerics.interpolation import interpolation, series
from rodloop_cli.physics.energies import Quadrature
from rodloop_cli.physics.equations import Load

INSIDE = np.s_[..., :-1]
"""The Gauss points of arrays that also hold the right ends."""


class EnergyAccount:
    """Adds up the dissipated energy from step to step and keeps the total at t = 0 as reference."""

    def __init__(self, load: Load) -> None:
        self._load = load
        self._dissipated = 0.0
        self._first: tuple[float, float] | None = None
        self._film: tuple[Step, Array] | None = None
        self.largest_residual = 0.0
        self.largest_change = 0.0

    def at(self, step: Step, shapes: Shapes, quadrature: Quadrature) -> list[dict[str, float]]:
        """Every energy at the instants of a step."""
        tangent, velocity = shapes.tangent, shapes.velocity[INSIDE]
        kinetic = quadrature.kinetic(velocity)
        if self._load.rotary_inertia:
            kinetic = kinetic + quadrature.rotary(shapes.spin, self._load.rotary_inertia)
        instants = zip(
            quadrature.area(shapes.position[INSIDE], tangent).tolist(),
            quadrature.bending(shapes.moment[INSIDE]).tolist(),
            kinetic.tolist(),
            self._taken(step, shapes.times, quadrature),
            quadrature.dissipation_rate(velocity, tangent, self._load).tolist(),
            strict=True,
        )
        return [self._balance(*instant) for instant in instants]

    def _balance(self, area: float, bending: float, kinetic: float, taken: float, rate: float) -> dict[str, float]:
        """The energies of an instant, the residual among them; ``taken`` by the film since the start of the step."""
        surface, dissipated = self._load.p * area, self._dissipated + taken
        return {
            "bending_energy": bending,
            "surface_energy": surface,
            "kinetic_energy": kinetic,
            "dissipated_energy": dissipated,
            "energy_residual": self._residual(
                bending + surface + kinetic + dissipated, surface, max(kinetic, dissipated)
            ),
            "dissipation_rate": rate,
            "area": area,
        }

    def close(self, step: Step, quadrature: Quadrature) -> None:
        """Add what the film took in the whole step."""
        if self._load.zeta_perp:
            power = self._power_in(step, quadrature)
            self._dissipated += step.size * float(power @ gauss_rule(len(power)).weights)

    def memory(self) -> tuple[float, ...]:
        """What a continued run needs to know."""
        assert self._first is not None
        return (self._dissipated, *self._first, self.largest_residual, self.largest_change)

    def restore(self, memory: Array) -> None:
        """Go on where the account with this memory was."""
        self._dissipated, total, surface, self.largest_residual, self.largest_change = map(float, memory)
        self._first = total, surface

    def _residual(self, total: float, surface: float, gained: float) -> float:
        first_total, first_surface = self._first = self._first or (total, surface)
        residual = total - first_total
        self.largest_residual = max(self.largest_residual, abs(residual))
        self.largest_change = max(self.largest_change, abs(surface - first_surface), gained)
        return residual

    def _taken(self, step: Step, times: Array, quadrature: Quadrature) -> list[float]:
        """(k,): energy taken by the film from the start of the step."""
        if not self._load.zeta_perp:
            return [0.0] * len(times)
        power = self._power_in(step, quadrature)
        coefficients = interpolation(_places(len(power))).integrals @ (step.size * power)
        taken: list[float] = (series(fractions(step, times), len(coefficients)) @ coefficients).tolist()
        return taken

    def _power_in(self, step: Step, quadrature: Quadrature) -> Array:
        """(s + 1,): what the film takes, at Gauss points in time."""
        if self._film is None or self._film[0] is not step:
            shapes = Shapes.inside(step, _places(len(step.nodes) + 1))
            power = quadrature.dissipation_rate(shapes.velocity[INSIDE], shapes.tangent, self._load)
            self._film = step, power
        return self._film[1]


@cache
def _places(points: int) -> tuple[float, ...]:
    """The Gauss points in a step."""
    return tuple(gauss_rule(points).points.tolist())
