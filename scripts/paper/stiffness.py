"""Figs. 8 to 14: loops with a stiffer half."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rodloop_cli.plot import draw_energies, draw_forces, draw_shape
from scripts.paper.panels import (
    draw_buckling,
    draw_energy_panels,
    draw_midpoint,
    draw_row,
    frames_at,
    letter,
    new_figure,
)
from scripts.paper.results import result, table

DRAGS = (1, 2, 3)
SHOWN = (1, 1.25, 1.5, 3, 4, 5)
"""Stiffness ratios of the shapes in Fig. 8a."""


def fitted(ratio: np.ndarray) -> np.ndarray:
    """The paper's fit of p(α = 0.9999) for equal segments, Eq. (19)."""
    return np.asarray(6 * np.sqrt(ratio) / (ratio**6 + ratio**-6))


def fig08() -> Figure:
    """The area-controlled measure of the critical pressure over stiffness ratio, for several fractions k."""
    equal, unequal = table("fig08a"), table("fig08b")
    figure = new_figure(11, 4.4)
    left, right = figure.subplots(1, 2)
    _draw_critical(left, equal, equal["stiffness_ratio"].to_numpy())
    ratio = np.linspace(0.2, 5, 400)
    left.plot(ratio, fitted(ratio), color="#8c8c8c", lw=1, label="Eq. (19)")
    _draw_unloaded(left.inset_axes((0.42, 0.2, 0.57, 0.5)))
    _draw_critical(right, unequal, unequal["stiffness_ratio"].to_numpy())
    for ax, name in zip((left, right), "ab", strict=True):
        ax.set(xlabel="stiffness ratio $B_2/B_1$", ylabel=r"$p(\alpha = 0.9999)\, R^3/B_1$")
        ax.legend()
        letter(ax, name)
    return figure


def _draw_critical(ax: Axes, found: xr.Dataset, ratio: np.ndarray) -> None:
    for column, k in enumerate(found["k"].to_numpy()):
        ax.plot(ratio, found["p_alpha"].to_numpy()[0, :, column], marker=".", label=f"$k = {k:g}$")


def _draw_unloaded(ax: Axes) -> None:
    """Shapes without load, from the first frames of short runs."""
    for place, ratio in enumerate(SHOWN):
        run = result("fig09", f"stiffness_ratio={ratio}", "t_end=1e-6", "snapshots=2")
        x, y = 2.5 * (place % 3), -3.0 * (place // 3)
        draw_shape(ax, run.assign(y=run["y"] + y), 0, shift=x)
        ax.text(x, y - 1.25, f"${ratio:g}$", ha="center", va="top", size=7)
    ax.set_aspect("equal")
    ax.set_axis_off()


def fig09() -> Figure:
    """One swing of a loop with a stiffer half, and its forces."""
    run = result("fig09")
    figure = new_figure(11, 6.5)
    axes = figure.subplot_mosaic("SS;FN", height_ratios=[1, 1.5])
    draw_row(axes["S"], run, frames_at(run, (0, 0.55, 0.8, 1.125)))
    letter(axes["S"], "a", "returns at 2.25, 1.7, 1.45")
    frames = frames_at(run, (0.55, 1.125, 2.25))
    draw_forces(axes["F"], run, "axial", frames)
    draw_forces(axes["N"], run, "shear", frames)
    letter(axes["F"], "b")
    letter(axes["N"], "c")
    return figure


def fig10() -> Figure:
    """Energies of the same loop over three periods."""
    figure = new_figure(7.5, 4)
    draw_energies(figure.subplots(), result("fig09"))
    return figure


def fig11() -> Figure:
    """Buckling at two stiffness ratios and four pressures."""
    figure = new_figure(19, 15.5)
    upper, lower = figure.subfigures(2, 1, squeeze=False)[:, 0]
    draw_buckling(upper, tuple(f"fig11{panel}" for panel in "abcd"), "abcd")
    draw_buckling(lower, tuple(f"fig11{panel}" for panel in "efgh"), "efgh")
    return figure


def fig12() -> Figure:
    """Damped oscillation after rupture of the outer film."""
    return _damped("fig12", (0, 0.4, 0.755, 1.1, 1.4, 2.1, 3.0, 8.0))


def fig13() -> Figure:
    """Damped oscillation after rupture of the inner film."""
    return _damped("fig13", (0, 0.3, 0.56, 0.8, 1.1, 1.65, 3.0, 8.0))


def _damped(name: str, times: tuple[float, ...]) -> Figure:
    runs = [result(f"{name}_drag{drag}") for drag in DRAGS]
    figure = new_figure(11, 5.6)
    upper, lower = figure.subplots(2, 1, height_ratios=[1, 1.7])
    draw_row(upper, runs[1], frames_at(runs[1], times))
    draw_midpoint(lower, runs, [rf"$\zeta_\perp = {drag}$" for drag in DRAGS])
    return figure


def fig14() -> Figure:
    """Energies and dissipation of both damped loops."""
    figure = new_figure(12, 6)
    draw_energy_panels(figure, ("fig12_drag2", "fig13_drag2"), "ab")
    return figure
