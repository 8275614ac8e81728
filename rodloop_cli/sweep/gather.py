"""sweep.nc: the scalars of all members over the axes of the grid, from the manifest."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from datetime import UTC, datetime
from itertools import chain
from pathlib import Path
from secrets import token_hex
from typing import Any

import netCDF4
import numpy as np
import numpy.typing as npt

from rodloop_cli import __version__
from rodloop_cli.case import Case
from rodloop_cli.dataset.provenance import CONVENTIONS, SOURCE
from rodloop_cli.dataset.variables import Attribute
from rodloop_cli.sweep.axes import Axis, is_number
from rodloop_cli.sweep.columns import COLUMNS, Column, Row, Status, status_of
from rodloop_cli.sweep.manifest import SUMMARY, Manifest
from rodloop_cli.sweep.plan import Plan

_WORD = str.maketrans({".": "_", "-": "_"})


def gather(plan: Plan, folder: Path) -> Path:
    """Write sweep.nc, whole or not at all; members without a row are marked as not run.

    Sweeps that share the folder may end at the same moment: each writes a file of its own, and the last one stays.
    """
    columns = _filled(plan, Manifest(folder).fresh())
    path = folder / SUMMARY
    part = path.with_name(f"{SUMMARY}.{token_hex(4)}.part")
    try:
        with netCDF4.Dataset(part, "w", format="NETCDF4") as dataset:
            _write(dataset, plan, columns)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    return path


def _filled(plan: Plan, rows: Iterable[Row]) -> dict[str, npt.NDArray[Any]]:
    """Each column over all members, in the order of the plan."""
    count = len(plan.members)
    columns = {column.name: np.full(count, column.missing, dtype=_memory_type(column)) for column in COLUMNS}
    columns["member"][:] = [member.name for member in plan.members]
    by_key: dict[str, list[int]] = {}
    for i, member in enumerate(plan.members):
        by_key.setdefault(member.key, []).append(i)
    for row in rows:
        for i in by_key.get(str(row["key"]), ()):
            _put(columns, i, row)
    return columns


def _put(columns: Mapping[str, npt.NDArray[Any]], i: int, row: Row) -> None:
    """Enter a row; one that failed does not replace a result, which another sweep may have reached."""
    status = status_of(row)
    if not status.is_done and Status(columns["status"][i]).is_done:
        return
    for column in COLUMNS:
        if column.name != "member":
            value = row.get(column.name, column.missing)
            columns[column.name][i] = value if isinstance(value, str) == (column.dtype == "str") else column.missing


def _memory_type(column: Column) -> Any:
    return object if column.dtype == "str" else column.dtype


def _write(dataset: netCDF4.Dataset, plan: Plan, columns: Mapping[str, npt.NDArray[Any]]) -> None:
    axes = plan.sweep.axes
    dataset.setncatts(_global_attributes(plan))
    for axis in axes:
        dataset.createDimension(dimension(axis), len(axis))
    labels = " ".join(chain.from_iterable(_write_axis(dataset, axis) for axis in axes))
    order = np.ix_(*(_order(axis) for axis in axes))
    for column in COLUMNS:
        variable = _create(dataset, column, tuple(dimension(axis) for axis in axes))
        variable.setncatts(column.attributes | ({"coordinates": labels} if labels else {}))
        variable[:] = columns[column.name].reshape(plan.shape)[order]


def _create(dataset: netCDF4.Dataset, column: Column, dims: tuple[str, ...]) -> netCDF4.Variable[Any]:
    if column.dtype == "str":
        return dataset.createVariable(column.name, str, dims)
    fill = None if column.name == "status" else column.missing
    return dataset.createVariable(column.name, column.dtype, dims, fill_value=fill, compression="zlib", complevel=1)


def _global_attributes(plan: Plan) -> dict[str, Attribute]:
    now = f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}"
    return {
        "Conventions": CONVENTIONS,
        "title": str(plan.sweep.base.values.get("title") or "").strip() or "Parameter sweep",
        "history": f"{now}: gathered from {len(plan.members)} members",
        "source": f"{SOURCE} sweep {__version__}, motion of an elastic rod loop in a soap film",
        "rodloop_content": "sweep",
        "output": "fields" if plan.sweep.keeps_fields else "scalars",
    }


# -- axes


def dimension(axis: Axis) -> str:
    """Name of the dimension: of its key, with underscores, as netCDF names have no dots."""
    return axis.name.translate(_WORD)


def _order(axis: Axis) -> npt.NDArray[np.intp]:
    """Points of an axis as sweep.nc has them: numbers ascending, as CF wants coordinates, others as written."""
    if not axis.is_numeric:
        return np.arange(len(axis))
    return np.argsort([point[0] for point in axis.points])


def _write_axis(dataset: netCDF4.Dataset, axis: Axis) -> Iterator[str]:
    """Write the values of an axis; yields the names of those that are no coordinates in the sense of CF."""
    for key, values in zip(axis.keys, zip(*axis.points, strict=True), strict=True):
        name = _label_name(axis, key)
        ordered = [values[i] for i in _order(axis)]
        numeric = all(is_number(value) for value in values)
        variable = dataset.createVariable(name, "f8" if numeric else str, (dimension(axis),))
        units = {"units": "rad" if key.endswith(".phase") else "1"} if numeric else {}
        variable.setncatts({"long_name": _meaning(key), **units})
        variable[:] = np.array(ordered, dtype="f8") if numeric else np.array([str(v) for v in ordered], dtype=object)
        if not axis.is_numeric:
            yield name


def _label_name(axis: Axis, key: str) -> str:
    """A variable with the name of its dimension is a coordinate, which CF wants numeric and monotonic."""
    name = key.translate(_WORD)
    return f"{name}_label" if name == dimension(axis) and not axis.is_numeric else name


def _meaning(key: str) -> str:
    """What the case file's schema says of a key."""
    for name, info in Case.model_fields.items():
        if key == (info.alias or name) and info.description:
            return info.description.splitlines()[0].rstrip(".")
    return key
