"""The energy account of a run: every energy at the stored times, and the residual that should be zero."""

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
    """Adds up the dissipated energy from step to step and keeps the first row's total as reference."""

    def __init__(self, load: Load) -> None:
        self._load = load
        self._dissipated = 0.0
        self._first: tuple[float, float] | None = None
        self._film: tuple[Step, Array] | None = None
        self.largest_residual = 0.0
        self.largest_change = 0.0

    def at(self, step: Step, shapes: Shapes, quadrature: Quadrature) -> dict[str, Array]:
        """(k,) of every energy at instants of a step."""
        area = quadrature.area(shapes.position[INSIDE], shapes.tangent)
        bending = quadrature.bending(shapes.moment[INSIDE])
        kinetic = quadrature.kinetic(shapes.velocity[INSIDE])
        if self._load.rotary_inertia:
            kinetic = kinetic + quadrature.rotary(shapes.spin, self._load.rotary_inertia)
        surface = self._load.p * area
        dissipated = self._dissipated + self._taken(step, shapes.times, quadrature)
        rate = quadrature.dissipation_rate(shapes.velocity[INSIDE], shapes.tangent, self._load)
        return {
            "bending_energy": bending,
            "surface_energy": surface,
            "kinetic_energy": kinetic,
            "dissipated_energy": dissipated,
            "energy_residual": self._residual(
                bending + surface + kinetic + dissipated, surface, np.maximum(kinetic, dissipated)
            ),
            "dissipation_rate": rate,
            "area": area,
        }

    def close(self, step: Step, quadrature: Quadrature) -> None:
        """Add what the film took in the whole step."""
        self._dissipated += float(self._taken(step, np.array([step.start.time + step.size]), quadrature)[0])

    def memory(self) -> tuple[float, ...]:
        """What a continued run needs to know."""
        first = self._first or (0.0, 0.0)
        return (self._dissipated, *first, self.largest_residual, self.largest_change)

    def restore(self, memory: Array) -> None:
        """Go on where the account with this memory was."""
        self._dissipated, total, surface, self.largest_residual, self.largest_change = map(float, memory)
        self._first = total, surface

    def _residual(self, total: Array, surface: Array, gained: Array) -> Array:
        if self._first is None:
            self._first = float(total[0]), float(surface[0])
        residual = total - self._first[0]
        self.largest_residual = max(self.largest_residual, float(np.abs(residual).max()))
        change = np.maximum(np.abs(surface - self._first[1]), gained)
        self.largest_change = max(self.largest_change, float(change.max()))
        return residual

    def _taken(self, step: Step, times: Array, quadrature: Quadrature) -> Array:
        """(k,): energy taken by the film from the start of the step."""
        if self._load.zeta_perp == 0:
            return np.zeros(len(times))
        if self._film is None or self._film[0] is not step:
            self._film = step, self._integrated_power(step, quadrature)
        coefficients = self._film[1]
        taken: Array = series(fractions(step, times), len(coefficients)) @ coefficients
        return taken

    def _integrated_power(self, step: Step, quadrature: Quadrature) -> Array:
        """The energy taken since the start of the step as a `series`, from the power at Gauss points in time."""
        nodes = gauss_rule(len(step.nodes) + 1).points
        shapes = Shapes(step, step.start.time + step.size * nodes)
        power = quadrature.dissipation_rate(shapes.velocity[INSIDE], shapes.tangent, self._load)
        return interpolation(tuple(nodes.tolist())).integrals @ (step.size * power)
