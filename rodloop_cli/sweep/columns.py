"""The one table of what a sweep keeps of every member: its row in the manifest, its variables in sweep.nc."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from rodloop_cli.dataset.variables import Attribute

Row = dict[str, str | int | float]
"""What is known of one member, by the names of the table and `key`; what was not found is left out."""


class Status(IntEnum):
    """How a member ended."""

    not_run = 0
    reached_end = 1
    crossed = 2
    settled = 3
    failed = 4

    @property
    def is_done(self) -> bool:
        """Whether there is a result that need not be computed again."""
        return self not in {Status.not_run, Status.failed}


_MISSING: dict[str, str | int | float] = {"f8": math.nan, "i4": -1, "i1": int(Status.not_run), "str": ""}


@dataclass(frozen=True)
class Column:
    """One scalar of a member; `dtype`: "f8", "i4", "i1" or "str"."""

    name: str
    long_name: str
    dtype: str = "f8"
    extras: Mapping[str, Attribute] = field(default_factory=dict)

    @property
    def attributes(self) -> dict[str, Attribute]:
        """The attributes that sweep.nc carries for this variable."""
        units: dict[str, Attribute] = {} if self.dtype == "str" else {"units": "1"}
        return {"long_name": self.long_name, **units, **self.extras}

    @property
    def missing(self) -> str | int | float:
        """What stands in sweep.nc where a member has no such value."""
        return _MISSING[self.dtype]


_TIME = {"comment": "in units of R^2 sqrt(rho1 A / B1)"}

COLUMNS = (
    Column(
        "status",
        "how the member ended",
        "i1",
        {
            "flag_values": np.array([status.value for status in Status], dtype=np.int8),
            "flag_meanings": " ".join(status.name for status in Status),
        },
    ),
    Column("outcome", "outcome of the run in words", "str"),
    Column("member", "name of the member; with .nc, of its result file", "str"),
    Column("end_time", "time at which the run ended", extras=_TIME),
    Column("period", "time between the first two minima of the enclosed area", extras=_TIME),
    Column("first_area_minimum_time", "time of the first minimum of the enclosed area", extras=_TIME),
    Column("first_area_minimum", "enclosed area over R^2 at its first minimum"),
    Column("minimum_area", "smallest enclosed area over R^2"),
    Column("first_crossing_time", "time at which the centreline first crosses itself", extras=_TIME),
    Column("settling_time", "time at which the loop came to rest", extras=_TIME | {"note": "with stop_at: settled"}),
    Column("peak_bending_energy", "largest bending energy in B1 / R"),
    Column("peak_surface_energy", "largest surface energy in B1 / R"),
    Column("peak_kinetic_energy", "largest kinetic energy in B1 / R"),
    Column("dissipated_energy", "energy dissipated by the film until the end, in B1 / R"),
    Column("largest_energy_residual", "largest error of the energy account in B1 / R"),
    Column("lobes_initial", "number of lobes of the initial shape", "i4"),
    Column("lobes_final", "number of lobes of the final shape", "i4"),
    Column("maximum_displacement", "largest distance of a point from its initial position over R"),
    Column(
        "growth_rate",
        "exponential growth rate fitted to the early departure from the initial shape",
        extras={"comment": "in units of sqrt(B1 / (rho1 A)) / R^2; missing where the departure is not exponential"},
    ),
    Column("steps", "time steps", "i4"),
    Column("rejected", "rejected time steps", "i4"),
    Column("newton_iterations", "Newton iterations", "i4"),
    Column("factorizations", "factorizations of the linear system", "i4"),
    Column("cells", "cells of the final mesh", "i4"),
    Column("solver_seconds", "time spent in the time loop", extras={"units": "s", "comment": "wall clock"}),
    Column("cpu_seconds", "processor time from start to closed file", extras={"units": "s"}),
    Column("wall_seconds", "time from start to closed file", extras={"units": "s", "comment": "wall clock"}),
)

NAMES = frozenset(column.name for column in COLUMNS)


def status_of(row: Mapping[str, object]) -> Status:
    """The status in a row; rows that were torn or tampered with have none."""
    code = row.get("status")
    return Status(code) if isinstance(code, int) and code in set(Status) else Status.not_run
