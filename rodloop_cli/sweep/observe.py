"""The scalars of a member, taken from its rows as they pass to the result file, or to nowhere."""

from __future__ import annotations

import json
from collections.abc import Mapping

import numpy as np

from rodloop_cli.dataset.provenance import GOOD_ENDS
from rodloop_cli.dataset.rows import Row as Snapshot
from rodloop_cli.dataset.rows import RowSink
from rodloop_cli.dataset.variables import Attribute
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.sweep.columns import NAMES, Row, Status
from rodloop_cli.sweep.growth import Departure
from rodloop_cli.sweep.ledger import ROW_ATTRIBUTE

_ENDINGS = dict(zip(GOOD_ENDS, (Status.reached_end, Status.crossed, Status.settled), strict=True))
"""How the outcomes of completed runs begin; all others are failures."""


class Nowhere:
    """A sink that keeps nothing."""

    def append(self, row: Snapshot) -> None:
        """Forget one stored time."""

    def flush_if_due(self) -> None:
        """Nothing is ever due."""

    def finish(self, attributes: Mapping[str, Attribute]) -> None:
        """Forget how it ended."""


class Observer:
    """Passes rows on to a sink and remembers of them what a sweep keeps.

    `row` is the member's row once the run has finished; it begins as what is known beforehand.
    """

    def __init__(self, sink: RowSink, known: Row, *, has_drag: bool) -> None:
        self.row = known
        self.sink = sink
        self._departure = Departure(has_drag)
        self._start: Array | None = None
        self._peaks = {"bending_energy": -np.inf, "surface_energy": -np.inf, "kinetic_energy": -np.inf}
        self._displacement = 0.0
        self._area = np.inf
        self._time = 0.0

    def append(self, row: Snapshot) -> None:
        """Take one stored time."""
        self._watch_shape(row)
        for name, peak in self._peaks.items():
            self._peaks[name] = max(peak, float(np.asarray(row[name])))
        self._area = min(self._area, float(np.asarray(row["area"])))
        self.row["dissipated_energy"] = float(np.asarray(row["dissipated_energy"]))
        self.row["lobes_final"] = int(np.asarray(row["lobes"]))
        self.row.setdefault("lobes_initial", self.row["lobes_final"])
        self.sink.append(row)

    def flush_if_due(self) -> None:
        """The sink may have rows that wait."""
        self.sink.flush_if_due()

    def reached(self, time: float) -> None:
        """Note the time of the run, which stops between stored times."""
        self._time = time

    def finish(self, attributes: Mapping[str, Attribute]) -> None:
        """Complete the row with what the run knows at its end, and pass both on."""
        self.row |= self._scalars(attributes)
        self.sink.finish({**attributes, ROW_ATTRIBUTE: json.dumps(self.row, allow_nan=False)})

    def _watch_shape(self, row: Snapshot) -> None:
        shape = np.stack([np.asarray(row["x"]), np.asarray(row["y"])])
        if self._start is None:
            self._start = shape
        displacement = shape - self._start
        self._displacement = max(self._displacement, float(np.hypot(*displacement).max()))
        velocity = np.stack([np.asarray(row["velocity_x"]), np.asarray(row["velocity_y"])])
        self._departure.watch(float(np.asarray(row["t"])), displacement, velocity)

    def _scalars(self, attributes: Mapping[str, Attribute]) -> Row:
        # Lists, as of the lobes that were lost, have no place in a row.
        singles = {name: value for name, value in attributes.items() if np.ndim(value) == 0}
        plain = {name.removeprefix("total_"): _plain(value) for name, value in singles.items()}
        status = next((s for text, s in _ENDINGS.items() if str(plain["outcome"]).startswith(text)), Status.failed)
        scalars: Row = {name: value for name, value in plain.items() if name in NAMES and name != "wall_seconds"}
        scalars |= {"status": int(status), "end_time": self._time, "solver_seconds": plain["wall_seconds"]}
        if status is Status.settled:
            scalars["settling_time"] = self._time
        rate = self._departure.rate()
        if rate is not None:
            scalars["growth_rate"] = rate
        return scalars | self._extremes(plain)

    def _extremes(self, plain: Mapping[str, str | int | float]) -> Row:
        if self._start is None:  # not a single stored time
            return {}
        least = min(self._area, float(plain.get("first_area_minimum", np.inf)))
        peaks: Row = {f"peak_{name}": peak for name, peak in self._peaks.items()}
        return {"maximum_displacement": self._displacement, "minimum_area": least, **peaks}


def _plain(value: Attribute) -> str | int | float:
    if isinstance(value, str):
        return value
    number: int | float = np.asarray(value).item()
    return number
