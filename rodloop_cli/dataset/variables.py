"""The one table of what a result file holds: names, dimensions, types, units, meanings.

The writer, the in-memory dataset and the reader all go by it, so that they cannot drift apart. Everything is
nondimensional as in the paper: lengths in R, forces in B1/R^2, energies in B1/R, time in R^2 sqrt(rho1 A/B1).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

Attribute = str | int | float | np.integer | np.floating | npt.NDArray[np.generic]
"""What a netCDF attribute may be here; never bool, None or a mapping (CF forbids them)."""


@dataclass(frozen=True)
class Variable:
    """One variable of the result file; `dims`: ("t",), ("s",) or ("t", "s"); `dtype`: a numpy code."""

    name: str
    dims: tuple[str, ...]
    long_name: str
    units: str = "1"
    dtype: str = "f8"
    extras: Mapping[str, Attribute] = field(default_factory=dict)

    @property
    def attributes(self) -> dict[str, Attribute]:
        """The attributes that the file carries for this variable."""
        return {"long_name": self.long_name, "units": self.units, **self.extras}


def _profile(name: str, long_name: str, units: str = "1", **extras: Attribute) -> Variable:
    return Variable(name, ("t", "s"), long_name, units, extras=extras)


def _scalar(name: str, long_name: str, dtype: str = "f8", **extras: Attribute) -> Variable:
    return Variable(name, ("t",), long_name, dtype=dtype, extras=extras)


TIME = Variable(
    "t",
    ("t",),
    "time",
    # No `axis` and no standard_name: either makes CF ask for calendar units, which t has not.
    extras={"comment": "in units of R^2 sqrt(rho1 A / B1)"},
)

ARCLENGTH = Variable(
    "s",
    ("s",),
    "arclength from the bottom of the loop, counter-clockwise",
    extras={"comment": "in units of R = L / (2 pi); the loop closes at 2 pi, which is not repeated"},
)

SEGMENT = Variable("segment", ("s",), "number of the segment that the point belongs to, from 1", dtype="i4")

PROFILES = (
    _profile("x", "horizontal position over R"),
    _profile("y", "vertical position over R"),
    _profile("theta", "tangent angle, continuous along s", units="rad"),
    _profile("curvature", "curvature times R", comment="jumps where the bending stiffness does"),
    _profile("moment", "bending moment M R / B1", comment="continuous along s"),
    _profile("axial_force", "axial internal force in B1 / R^2, tension positive"),
    _profile("shear_force", "shear internal force in B1 / R^2, along the inward normal"),
    _profile("velocity_x", "horizontal velocity"),
    _profile("velocity_y", "vertical velocity"),
)

SCALARS = (
    _scalar("bending_energy", "bending energy in B1 / R"),
    _scalar("surface_energy", "surface energy in B1 / R, the pressure times the enclosed area"),
    _scalar("kinetic_energy", "kinetic energy in B1 / R"),
    _scalar("dissipated_energy", "energy dissipated by the film since t = 0, in B1 / R"),
    _scalar(
        "energy_residual",
        "sum of the four energies minus its value at t = 0, in B1 / R",
        comment="zero in the exact motion: the size of the error that this run made",
    ),
    _scalar("dissipation_rate", "power dissipated by the film"),
    _scalar("area", "signed area enclosed by the centreline over R^2"),
    _scalar("lobes", "number of lobes of the shape", dtype="i4", comment="0 for a circle"),
    _scalar(
        "crossing",
        "whether the centreline crosses itself",
        dtype="i1",
        flag_values=np.array([0, 1], dtype=np.int8),
        flag_meanings="simple crossing",
        comment="the model has no contact: a shape that crosses itself is not physical, nor is any later one",
    ),
    _scalar("step_size", "length of the time step that ends at or passes this time, 0 at the start"),
    _scalar("newton_iterations", "Newton iterations of that time step, 0 at the start", dtype="i4"),
)

COORDINATES = (TIME, ARCLENGTH)
IN_A_ROW = (*PROFILES, *SCALARS, TIME)
"""What `append` expects of every stored time, and nothing else; the time last: it seals a row in the file."""

TABLE = (ARCLENGTH, TIME, SEGMENT, *PROFILES, *SCALARS)

LOBE_EVENT_TIMES = "lobe_event_times"
LOBE_EVENT_ARCLENGTHS = "lobe_event_arclengths"
LOBE_EVENT_FATES = "lobe_event_fates"
"""Global attributes with an entry for each lobe that was lost: when and where it was last seen, and its fate."""
