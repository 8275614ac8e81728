"""A netCDF file made after the table: dimensions, variables, attributes, chunks; no rows yet."""

from __future__ import annotations

from collections.abc import Mapping

import netCDF4
import numpy as np
import numpy.typing as npt

from rodloop_cli.dataset.variables import IN_A_ROW, SEGMENT, TABLE, Attribute, Variable

KEPT_BYTES = 2**20
"""Of each variable, in memory while the file is written."""

BLOCK_ROWS = 50
"""Rows of a chunk and of a write: about 64, and a divisor of the default number of snapshots, so that
nothing is padded. Measured on 200 x 200 points: 3.0 MB in 25 ms, against 1.3 MB in 65 ms with zlib level 1
and shuffle; the whole run takes some 300 ms, so the file is not compressed."""

_CHUNK_POINTS = 4096
_CHUNK_NUMBERS = 512


def create_layout(
    dataset: netCDF4.Dataset,
    s: npt.NDArray[np.float64],
    segment: npt.NDArray[np.integer],
    attributes: Mapping[str, Attribute],
) -> None:
    """Fill an empty file with everything that is known before the first row; `s`, `segment` [S]."""
    dataset.setncatts(attributes)
    dataset.createDimension("t", None)
    dataset.createDimension("s", len(s))
    for variable in TABLE:
        _create_variable(dataset, variable, len(s))
    dataset.variables["s"][:] = s
    dataset.variables[SEGMENT.name][:] = segment


def _create_variable(dataset: netCDF4.Dataset, variable: Variable, points: int) -> None:
    chunks = {
        ("t",): (_CHUNK_NUMBERS,),
        ("s",): None,
        ("t", "s"): (BLOCK_ROWS, min(points, _CHUNK_POINTS)),
    }[variable.dims]
    # Only `t` is filled beforehand: a time that reads as the fill value marks a row that was never completed.
    # Neither way of creating it gives a variable the attribute _FillValue, which CF forbids on coordinates.
    fill = None if variable.name == "t" else False
    created = dataset.createVariable(variable.name, variable.dtype, variable.dims, chunksizes=chunks, fill_value=fill)
    # Blocks are written once, in order: the 16 MB that HDF5 would keep of every variable are of no use.
    created.set_var_chunk_cache(size=KEPT_BYTES)
    created.setncatts(variable.attributes)


def row_bytes(points: int) -> int:
    """Size on disk of one stored time, in bytes."""
    return sum(np.dtype(v.dtype).itemsize * (points if "s" in v.dims else 1) for v in IN_A_ROW)
