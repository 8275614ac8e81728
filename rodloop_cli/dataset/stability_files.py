"""Files of `rodloop modes` and `rodloop critical`: what is in them, how they are written and read.

Like result files they are CF-1.11, nondimensional as in the paper; the attribute `rodloop_content` tells them apart.
"""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

import netCDF4
import numpy as np
import numpy.typing as npt

from rodloop_cli.dataset.provenance import CONVENTIONS, SOURCE, clean_attributes, versions
from rodloop_cli.dataset.variables import ARCLENGTH, SEGMENT, Attribute, Variable
from rodloop_cli.dataset.writer import check_target, part_path
from rodloop_cli.errors import OutputError

if TYPE_CHECKING:
    import xarray as xr

MODES, CRITICAL = "modes", "critical"

_P = Variable("p", ("p",), "pressure p R^3 / B1, positive where the outer film is ruptured")
_MODE = Variable("mode", ("mode",), "rank of the mode, the fastest growing first", dtype="i4")
_RATE = "in sqrt(B1 / (rho1 A)) / R^2; the motion is the real part of shape exp((growth_rate + i frequency) t)"


def _of_mode(name: str, long_name: str, units: str = "1", dtype: str = "f8", **extras: Attribute) -> Variable:
    return Variable(name, ("p", "mode"), long_name, units, dtype, extras)


def _shape(name: str, long_name: str, units: str = "1") -> Variable:
    return Variable(name, ("p", "mode", "s"), long_name, units)


def _base(name: str, long_name: str) -> Variable:
    return Variable(name, ("p", "s"), long_name)


MODE_TABLE = (
    _P,
    _MODE,
    ARCLENGTH,
    SEGMENT,
    _base("x", "horizontal position of the base state over R"),
    _base("y", "vertical position of the base state over R"),
    _base("curvature", "curvature of the base state times R"),
    _of_mode("growth_rate", "growth rate, the real part of the eigenvalue", comment=_RATE),
    _of_mode("frequency", "angular frequency, the imaginary part of the eigenvalue", comment=_RATE),
    _of_mode("lobes", "number of lobes of the mode", dtype="i4"),
    _shape("displacement_x", "horizontal displacement, real part, the largest component scaled to 1"),
    _shape("displacement_y", "vertical displacement, real part"),
    _shape("turning", "change of the tangent angle, real part", "rad"),
    _shape("curvature_change", "change of the curvature times R, real part"),
    _shape("displacement_x_imaginary", "horizontal displacement, imaginary part"),
    _shape("displacement_y_imaginary", "vertical displacement, imaginary part"),
    _shape("turning_imaginary", "change of the tangent angle, imaginary part", "rad"),
    _shape("curvature_change_imaginary", "change of the curvature times R, imaginary part"),
)

_RODS = ("stiffness_ratio", "k")
_AT_AREA = ("alpha", *_RODS)
_NONE = "missing where there is none up to p_searched, or where it could not be computed"
KINDS = ("none", "bifurcation", "fold", "not_computed")


def _of_rod(name: str, long_name: str, **extras: Attribute) -> Variable:
    return Variable(name, _RODS, long_name, extras=extras)


CRITICAL_TABLE = (
    Variable("alpha", ("alpha",), "enclosed area over that of the unloaded loop"),
    Variable("stiffness_ratio", ("stiffness_ratio",), "stiffness ratio B2 / B1 of the segments"),
    Variable("k", ("k",), "fraction of the arclength in segment 1"),
    Variable("p_alpha", _AT_AREA, "pressure at which least bending energy has area alpha A0, times R^3 / B1"),
    Variable("p_limit", _AT_AREA, "limit of p_alpha for alpha to 1, times R^3 / B1"),
    _of_rod("compressibility", "relative loss of area per unit of pressure at zero pressure"),
    _of_rod("p_stability", "pressure of the first loss of stability, times R^3 / B1", comment=_NONE),
    Variable(
        "stability_kind",
        _RODS,
        "how stability is lost",
        dtype="i1",
        extras={"flag_values": np.arange(4, dtype=np.int8), "flag_meanings": " ".join(KINDS)},
    ),
    _of_rod(
        "p_soft",
        "pressure at which the slowest motion has kept 1 percent of its squared frequency, times R^3 / B1",
        comment=_NONE,
    ),
    _of_rod("p_contact", "pressure of the first self-contact, times R^3 / B1", comment=_NONE),
    _of_rod("p_searched", "pressure at which the search ended, times R^3 / B1"),
)

Columns = Mapping[str, npt.ArrayLike]


def write_table(
    path: Path, content: str, columns: Columns, attributes: Mapping[str, Attribute], *, force: bool = False
) -> Path:
    """Write a modes or critical file whole or not at all; ``columns`` holds every variable of its table.

    Raises OutputError for a path that is refused or cannot be written.
    """
    check_target(path, force=force)
    table = MODE_TABLE if content == MODES else CRITICAL_TABLE
    part = part_path(path)
    try:
        with netCDF4.Dataset(part, "w", format="NETCDF4") as dataset:
            dataset.setncatts(_attributes(content, attributes))
            _fill(dataset, table, columns)
        part.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            part.unlink()
        raise OutputError(f"{path}: cannot be written ({error.strerror or error})") from error
    return path


def open_table(path: Path) -> xr.Dataset:
    """A modes or critical file, read whole. Raises OutputError if it cannot be, or is neither."""
    import xarray as xr  # noqa: PLC0415  takes a second

    try:
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            read = dataset.load()
    except (OSError, RuntimeError, ValueError) as error:
        raise OutputError(f"{path} is damaged and cannot be read ({error})") from error
    table = {MODES: MODE_TABLE, CRITICAL: CRITICAL_TABLE}.get(str(read.attrs.get("rodloop_content")), ())
    missing = [variable.name for variable in table if variable.name not in read.variables]
    if not table or missing:
        raise OutputError(f"{path} is not a result of this version's rodloop modes or rodloop critical")
    return read


def _attributes(content: str, given: Mapping[str, Attribute]) -> dict[str, Attribute]:
    now = f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}"
    own: dict[str, Attribute] = {
        "Conventions": CONVENTIONS,
        "history": f"{now}: rodloop {content}",
        "source": f"{SOURCE} {versions()[SOURCE]}, {content} of an elastic rod loop in a soap film",
        "rodloop_content": content,
    }
    return clean_attributes(own | {f"version_{name}": text for name, text in versions().items()} | dict(given))


def _fill(dataset: netCDF4.Dataset, table: tuple[Variable, ...], columns: Columns) -> None:
    for variable in table:
        values = np.asarray(columns[variable.name])
        for dim, size in zip(variable.dims, values.shape, strict=True):
            if dim not in dataset.dimensions:
                dataset.createDimension(dim, size)
        missing = np.nan if variable.dtype == "f8" and variable.dims != (variable.name,) else False
        created = dataset.createVariable(variable.name, variable.dtype, variable.dims, fill_value=missing)
        created.setncatts(variable.attributes)
        created[:] = values
