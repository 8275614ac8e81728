"""Opening a result, with words for everything that is not one.

A file may come from a stranger: it is read as data only. Nothing in it is evaluated or decoded, its variables must be
those of the table in dimensions and type, and a declared size that the file cannot hold is refused before any
memory is taken.
"""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import netCDF4
import numpy as np

from rodloop_cli.case.wording import one_line
from rodloop_cli.dataset.memory import prepare_for_saving
from rodloop_cli.dataset.provenance import SOURCE
from rodloop_cli.dataset.variables import TABLE
from rodloop_cli.dataset.writer import part_path
from rodloop_cli.errors import OutputError

if sys.platform != "win32":
    import fcntl

if TYPE_CHECKING:
    import xarray as xr

_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_BROKEN = (OSError, RuntimeError, ValueError, TypeError, LookupError, AttributeError, ArithmeticError, MemoryError)
"""What netCDF4 and xarray raise on files that are damaged or made to confuse."""

_SMALL = 64 * 2**20
_INFLATION = 1100
"""A file may declare `_SMALL` bytes in any case, and beyond that what zlib can inflate: some 1030 to 1."""


def open_run(path: str | os.PathLike[str], *, partial: bool = False) -> xr.Dataset:
    """The result in `path`, read lazily: an xarray.Dataset over (t, s) that can be used in a `with` block.

    `partial` allows the rows that a killed run left behind in OUT.nc.part; `path` may name either.
    Raises OutputError if there is no such file, or it is not a result, not finished or damaged.
    """
    found = _find(Path(path), partial=partial)
    _check_signature(found)
    _check_contents(found)
    return _open(found)


def result_of(path: str | os.PathLike[str], sha256: str) -> dict[str, Any]:
    """The attributes of the closed result of the case with this key; empty if ``path`` is not that."""
    try:
        with netCDF4.Dataset(path) as raw:
            attributes = {name: raw.getncattr(name) for name in raw.ncattrs()}
    except _BROKEN:
        return {}
    return attributes if attributes.get("case_sha256") == sha256 and attributes.get("outcome") else {}


def _find(path: Path, *, partial: bool) -> Path:
    if _is_folder(path):
        raise OutputError(f"{path} is a folder, not a result file")
    part = path if path.suffix == ".part" else part_path(path)
    if path == part and not partial:
        raise OutputError(f"{path}: the run did not finish; partial=True opens the rows that it left")
    found = part if partial and not path.is_file() else path
    if found.is_file():
        return found
    hint = f"; an unfinished run left {part.name}, partial=True opens it" if part.is_file() else ""
    raise OutputError(f"{path}: no such file{hint}")


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except OSError as error:  # a name that is too long, a folder that may not be looked into
        raise OutputError(f"{one_line(str(path))}: cannot be read ({error.strerror})") from error


def _check_signature(path: Path) -> None:
    try:
        with path.open("rb") as file:
            signature = file.read(len(_SIGNATURE))
            busy = _is_being_written(file.fileno())
    except OSError as error:
        raise OutputError(f"{path}: cannot be read ({error.strerror})") from error
    if busy:
        raise OutputError(f"{path} is being written; wait until the run ends")
    if signature != _SIGNATURE:
        raise OutputError(f"{path} is not a netCDF-4 file")


def _is_being_written(descriptor: int) -> bool:
    """Whether a writer has the file open: HDF5 locks it then, and would call it an HDF error."""
    if sys.platform == "win32":
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:  # no locks on this file system
        return False
    fcntl.flock(descriptor, fcntl.LOCK_UN)
    return False


def _check_contents(path: Path) -> None:
    try:
        with netCDF4.Dataset(path) as raw:
            problem = _foreign(raw) or _oversized(raw, path.stat().st_size)
    except _BROKEN as error:
        raise OutputError(f"{path} is damaged and cannot be read ({error}); run the case again") from error
    if problem:
        raise OutputError(f"{path} {problem}")


def _foreign(raw: netCDF4.Dataset) -> str:
    if not str(getattr(raw, "source", "")).startswith(SOURCE):
        return f"is not a result of {SOURCE} run"
    wrong = [v.name for v in TABLE if not _is_as_declared(raw, v.name, v.dims, np.dtype(v.dtype))]
    if wrong:
        return f"is not a result of this version of {SOURCE} run: missing or different {', '.join(wrong)}"
    return "" if raw.dimensions["t"].size and raw.dimensions["s"].size else "holds no rows"


def _is_as_declared(raw: netCDF4.Dataset, name: str, dims: tuple[str, ...], dtype: np.dtype[np.generic]) -> bool:
    if name not in raw.variables:
        return False
    variable = raw.variables[name]
    # A variable of text or of a compound type has no `kind` at all or another one.
    same_type = getattr(variable.dtype, "kind", "") == dtype.kind and variable.dtype.itemsize == dtype.itemsize
    return variable.dimensions == dims and same_type


def _oversized(raw: netCDF4.Dataset, file_bytes: int) -> str:
    declared = sum(8 * math.prod(int(n) for n in v.shape) for v in raw.variables.values())
    if declared <= max(_SMALL, _INFLATION * file_bytes):
        return ""
    return f"is damaged: it declares {declared / 1e9:.3g} GB of data and is {file_bytes / 1e9:.3g} GB long"


def _open(path: Path) -> xr.Dataset:
    import xarray as xr  # noqa: PLC0415  takes a second

    try:
        # There is nothing to decode: no calendar, no packing. So nothing is, whatever the attributes say.
        dataset = xr.open_dataset(path, engine="netcdf4", decode_cf=False)
        rows = _sealed_rows(dataset["t"].to_numpy())
    except _BROKEN as error:
        raise OutputError(f"{path} is damaged and cannot be read ({error}); run the case again") from error
    return prepare_for_saving(dataset if rows == dataset.sizes["t"] else dataset.isel(t=slice(rows)))


def _sealed_rows(t: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> int:
    """Number of rows that were written completely: the time comes last and reads as a huge number until then."""
    sealed = np.isfinite(t) & (np.abs(t) < netCDF4.default_fillvals["f8"])
    sealed[1:] &= np.diff(t) > 0.0
    return int(np.argmin(sealed)) if not sealed.all() else len(t)
