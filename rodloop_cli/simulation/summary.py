"""What a run found and what it cost."""

from dataclasses import asdict, dataclass

from rodloop_cli.march.work import Work
from rodloop_cli.simulation.events import AreaExtrema


@dataclass
class Summary:
    """Filled in while the run goes on."""

    work: Work
    extrema: AreaExtrema
    outcome: str = ""
    first_crossing: float | None = None
    cells: int = 0
    energy_residual: float = 0.0
    energy_change: float = 0.0
    wall_seconds: float = 0.0

    @property
    def totals(self) -> dict[str, int | float]:
        """Counters for the file."""
        return {**asdict(self.work), "cells": self.cells, "wall_seconds": self.wall_seconds}

    @property
    def findings(self) -> dict[str, int | float]:
        """Times and extrema for the file; only those that were found."""
        found: dict[str, int | float] = {"largest_energy_residual": self.energy_residual}
        if self.first_crossing is not None:
            found["first_crossing_time"] = self.first_crossing
        if self.extrema.minima:
            found["first_area_minimum_time"], found["first_area_minimum"] = self.extrema.minima[0]
        if self.extrema.period is not None:
            found["period"] = self.extrema.period
        return found
