"""Opening the results of a sweep: the scalars at once, the motion of each member when it is asked for."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rodloop_cli.dataset import open_run
from rodloop_cli.errors import OutputError
from rodloop_cli.sweep.manifest import SUMMARY

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Collection:
    """A folder of results. `summary`: scalars over the axes of the grid, an xarray.Dataset."""

    folder: Path
    summary: xr.Dataset

    def member(self, **values: Any) -> xr.Dataset:
        """The motion of one member, read lazily, by its values on the axes: ``member(p=16, stiffness_ratio=5)``.

        Numbers need not be exact: the nearest value counts. Axes of one point may be left out.
        """
        return open_run(self.path(**values))

    def path(self, **values: Any) -> Path:
        """The result file of one member."""
        point = self.summary["member"]
        for name, value in values.items():
            is_number = name in point.indexes and point.indexes[name].dtype.kind in "iuf"
            point = point.sel({name: value}, method="nearest") if is_number else point.sel({name: value})
        point = point.squeeze()
        if point.ndim:
            raise OutputError(f"{self.folder}: several members; say which {', '.join(map(str, point.dims))}")
        return self.folder / f"{point.item()}.nc"

    def members(self) -> Iterator[tuple[dict[str, Any], xr.Dataset]]:
        """Every member that has a result, one after the other: its values on the axes, and its motion."""
        stacked = self.summary["member"].stack(point=list(self.summary["member"].dims))
        for point in stacked:
            path = self.folder / f"{point.item()}.nc"
            if path.is_file():
                names = [name for name in point.coords if name != "point"]
                yield {str(name): point[name].item() for name in names}, open_run(path)


def open_sweep(folder: str | os.PathLike[str]) -> Collection:
    """The results in a folder (or in the folder of a sweep.nc), read lazily.

    Raises OutputError if there is no sweep.nc, which `rodloop sweep` writes when it ends or is interrupted.
    """
    import xarray as xr  # noqa: PLC0415  takes a second

    place = Path(folder)
    path = place if place.name == SUMMARY else place / SUMMARY
    if not path.is_file():
        raise OutputError(f"{path}: no such file; 'rodloop sweep' writes it when it ends, so run it again to the end")
    try:
        summary = xr.open_dataset(path, engine="netcdf4")
    except (OSError, ValueError) as error:
        raise OutputError(f"{path} is damaged and cannot be read ({error}); run the sweep again") from error
    # Texts are labels of their axis as numbers are; in the file CF keeps them apart.
    labels = {name: str(name).removesuffix("_label") for name in summary.coords if str(name).endswith("_label")}
    for label, axis in labels.items():
        summary = summary.assign_coords({axis: summary[label]}).drop_vars(str(label))
    return Collection(path.parent, summary)
