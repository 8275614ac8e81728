"""Fig. C.1: how lobes are lost."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure, SubFigure

from rodloop_cli.plot import draw_curvature, draw_lobes, draw_speeds, lobe_events, mark_curvature, mark_lobe_events
from scripts.paper.panels import SPACING, frames_at, letter, new_figure
from scripts.paper.results import result

SHOWN = 8
VISIBLE = 0.4
"""Share of the run before lobes are visible, which the rows of shapes leave out."""


def figC1() -> Figure:
    """Shapes coloured by speed, lobes over time and curvature, for a small and a large perturbation."""
    figure = new_figure(16, 13)
    upper, lower = figure.subfigures(2, 1, squeeze=False)[:, 0]
    _draw_fate(upper, result("figC1_small"), "abcd")
    _draw_fate(lower, result("figC1_large"), "efgh")
    return figure


def _draw_fate(figure: SubFigure, run: xr.Dataset, letters: str) -> None:
    axes = figure.subplot_mosaic("SSSL;BBCD", height_ratios=[1, 1.2])
    end = float(run["t"][-1])
    frames = frames_at(run, np.linspace(VISIBLE * end, end, SHOWN).tolist())
    speeds = draw_speeds(axes["S"], run, frames, spacing=SPACING)
    figure.colorbar(speeds, ax=axes["S"], label="speed", shrink=0.8)
    since = 0.0
    for place, frame in enumerate(frames):
        mark_lobe_events(axes["S"], run, frame, since=since, shift=SPACING * place)
        since = float(run["t"][frame])
    letter(axes["S"], letters[0], str(run.attrs["title"]))
    draw_lobes(axes["L"], run)
    for panel, name, frame in zip("BCD", letters[1:], _around_losses(run), strict=True):
        draw_curvature(axes[panel], run, [frame])
        mark_curvature(axes[panel], run, frame)
        letter(axes[panel], name, f"curvature at {float(run['t'][frame]):.4g}")


def _around_losses(run: xr.Dataset) -> list[int]:
    """Before the last loss of a lobe, at it, and at the end."""
    end = float(run["t"][-1])
    last = max((event.time for event in lobe_events(run)), default=0.7 * end)
    return frames_at(run, (last - 0.1 * end, last, end))
