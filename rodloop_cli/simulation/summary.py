"""What a run found and what it cost."""

import time
from dataclasses import asdict, dataclass, field

import numpy as np

from rodloop_cli.dataset.variables import LOBE_EVENT_ARCLENGTHS, LOBE_EVENT_FATES, LOBE_EVENT_TIMES, Attribute
from rodloop_cli.march.work import Work
from rodloop_cli.physics.lobe_events import LobeWatch
from rodloop_cli.simulation.amplification import SUSPICIOUS, Amplification
from rodloop_cli.simulation.events import AreaExtrema

AMPLIFIED = (
    "buckling waves grew {excess:.0e} times more than the motion, out of errors too: compare with tol/100 before you "
    "trust the shapes"
)

LOST = "the steps lost {share:.0%} of the energy that changed hands: try a tighter tol (bdf2: a smaller dt, more N)"
LARGE_SHARE = 0.05
"""Of the energy that changes hands: a residual beyond this deserves a warning."""

ROUND_OFF, ROUND_OFF_SHARE = 1e-6, 1e-8
"""An energy residual below the first, or below this share of the energies of the circle, is that of rounded numbers
(above all of the forces at t = 0), whatever its share of what changes hands."""


@dataclass
class Summary:
    """Filled in while the run goes on."""

    work: Work
    amplification: Amplification
    energies: float
    """Of the circle, bending and surface, in B1/R."""
    extrema: AreaExtrema = field(default_factory=AreaExtrema)
    lobes: LobeWatch = field(default_factory=LobeWatch)
    outcome: str = ""
    first_crossing: float | None = None
    cells: int = 0
    energy_residual: float = 0.0
    energy_change: float = 0.0
    spent: float = 0.0
    """Seconds of a run that this one continues."""
    _clock: float = field(default_factory=time.perf_counter)

    @property
    def seconds(self) -> float:
        """Wall time since the initial state was found, that of continued runs included."""
        return self.spent + time.perf_counter() - self._clock

    @property
    def totals(self) -> dict[str, int | float]:
        """Counters for the file."""
        return {**asdict(self.work), "cells": self.cells, "wall_seconds": self.seconds}

    @property
    def lost_share(self) -> float:
        """The energy residual over the largest change of energy."""
        return self.energy_residual / self.energy_change if self.energy_change else 0.0

    @property
    def residual_is_noise(self) -> bool:
        """Whether the energy residual is that of rounded numbers, and large only against a loop that hardly moves."""
        noise = max(ROUND_OFF, ROUND_OFF_SHARE * self.energies)
        return self.lost_share > LARGE_SHARE and self.energy_residual <= noise

    @property
    def warnings(self) -> list[str]:
        """What the run has shown of its own accuracy."""
        shown = []
        if self.lost_share > LARGE_SHARE and not self.residual_is_noise:
            shown.append(LOST.format(share=self.lost_share))
        if self.amplification.excess > SUSPICIOUS:
            shown.append(AMPLIFIED.format(excess=self.amplification.excess))
        return shown

    @property
    def findings(self) -> dict[str, int | float]:
        """Times and extrema for the file; only those that were found."""
        found: dict[str, int | float] = {"largest_energy_residual": self.energy_residual}
        if self.first_crossing is not None:
            found["first_crossing_time"] = self.first_crossing
        minima = self.extrema.prominent_minima()
        if minima:
            found["first_area_minimum_time"], found["first_area_minimum"] = minima[0]
        if self.extrema.period is not None:
            found["period"] = self.extrema.period
        return found

    @property
    def lobe_events(self) -> dict[str, Attribute]:
        """The lobes that were lost, for the file; nothing if there are none."""
        events = sorted(self.lobes.events(), key=lambda event: event.time)
        if not events:
            return {}
        return {
            LOBE_EVENT_TIMES: np.array([event.time for event in events]),
            LOBE_EVENT_ARCLENGTHS: np.array([event.arclength for event in events]),
            LOBE_EVENT_FATES: " ".join(event.fate.value for event in events),
        }
