"""Physical axes beside the nondimensional ones, for results whose case tells its scales."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.transforms import ScaledTranslation

from rodloop_cli.case import parse_case
from rodloop_cli.case.scales import Scales
from rodloop_cli.errors import CaseError
from rodloop_cli.plot.look import figure_of

BELOW = 38.0
"""How far below the axes that of milliseconds stands, in points: clear of the label over it."""

POINTS_PER_INCH = 72
MILLI = 1e3


def scales_of(dataset: xr.Dataset) -> Scales | None:
    """The scales in the case that a result carries; None if it has none."""
    return _from_case(str(dataset.attrs.get("case", "")))


def milliseconds(ax: Axes, dataset: xr.Dataset) -> None:
    """A second time axis, in ms, under the first, Eq. (8)."""
    if scales := scales_of(dataset):
        lowered = ax.transAxes + ScaledTranslation(0, -BELOW / POINTS_PER_INCH, figure_of(ax).dpi_scale_trans)
        second = ax.secondary_xaxis(0, functions=_linear(MILLI * scales.time), transform=lowered)
        second.set_xlabel("time (ms)")


def millinewtons(ax: Axes, dataset: xr.Dataset) -> None:
    """A second force axis, in mN, on the right, Eq. (8)."""
    if scales := scales_of(dataset):
        second = ax.secondary_yaxis("right", functions=_linear(MILLI * scales.force))
        second.set_ylabel("force (mN)")


def _linear(unit: float) -> tuple[Any, Any]:
    """To the physical numbers and back."""
    return lambda value: value * unit, lambda value: value / unit


@lru_cache(maxsize=4)
def _from_case(text: str) -> Scales | None:
    try:
        return parse_case(text).scales
    except CaseError:  # written by another version, or tampered with
        return None
