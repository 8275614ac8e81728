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
    "a segment is compressed so far beyond its buckling load that waves grew {excess:.0e} times as much as the motion, "
    "out of errors too: shapes may be off by many tol; compare with tol/100, or perturb the modes that are to grow"
)


@dataclass
class Summary:
    """Filled in while the run goes on."""

    work: Work
    amplification: Amplification
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
    def warning(self) -> str:
        """What the run has shown of its own accuracy; empty if nothing."""
        excess = self.amplification.excess
        return AMPLIFIED.format(excess=excess) if excess > SUSPICIOUS else ""

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
