"""The same rows, kept in memory: what `simulate` returns is what the file would have held."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from rodloop_cli.dataset.layout import BLOCK_ROWS
from rodloop_cli.dataset.provenance import clean_attributes
from rodloop_cli.dataset.rows import Row, RowBlock
from rodloop_cli.dataset.variables import ARCLENGTH, COORDINATES, SEGMENT, Attribute, Variable

if TYPE_CHECKING:
    import xarray as xr


class MemoryRows:
    """Collects rows; `dataset()` gives the result, before `finish` without the attributes known at the end.

    `s` [S] in [0, 2 pi) and `segment` [S] are the output points; `attributes` is what is known beforehand.
    """

    def __init__(
        self,
        *,
        s: npt.NDArray[np.float64],
        segment: npt.NDArray[np.integer],
        attributes: Mapping[str, Attribute],
    ) -> None:
        self._fixed = [(ARCLENGTH, np.asarray(s)), (SEGMENT, np.asarray(segment))]
        self._attributes = clean_attributes(attributes)
        self._rows = RowBlock(len(s), BLOCK_ROWS)

    def append(self, row: Row) -> None:
        """Take one stored time."""
        if self._rows.full:
            self._rows.grow()
        self._rows.put(row)

    def flush_if_due(self) -> None:
        """Nothing is ever due in memory."""

    def finish(self, attributes: Mapping[str, Attribute]) -> None:
        """Add what is known at the end: outcome, totals."""
        self._attributes |= clean_attributes(attributes)

    def dataset(self) -> xr.Dataset:
        """All rows so far, as `open_run` would give them."""
        import xarray as xr  # noqa: PLC0415  takes a second, and a run to a file does without

        variables = {v.name: _to_xarray(v, values) for v, values in [*self._fixed, *self._rows.columns()]}
        coordinates = {v.name: variables.pop(v.name) for v in COORDINATES}
        return prepare_for_saving(xr.Dataset(variables, coordinates, self._attributes))


def prepare_for_saving(dataset: xr.Dataset) -> xr.Dataset:
    """The same dataset, set up so that its `to_netcdf` adds no _FillValue and keeps t unlimited."""
    for variable in dataset.variables.values():
        variable.encoding["_FillValue"] = None
    dataset.encoding["unlimited_dims"] = {"t"}
    return dataset


def _to_xarray(variable: Variable, values: npt.NDArray[np.generic]) -> xr.Variable:
    import xarray as xr  # noqa: PLC0415

    return xr.Variable(variable.dims, values.astype(variable.dtype), variable.attributes)
