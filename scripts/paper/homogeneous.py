"""Figs. 2 to 7: uniform loops."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rodloop_cli.plot import draw_curvature, draw_energies, draw_forces, milliseconds
from scripts.paper.panels import (
    draw_buckling,
    draw_energy_panels,
    draw_row,
    frames_at,
    letter,
    new_figure,
)
from scripts.paper.results import result

LARGEST_LOAD = 140.0
MODES = range(2, 9)


def growth_squared(n: int, p: np.ndarray) -> np.ndarray:
    """ω² of mode n of the uniform circle, Eq. (17)."""
    return np.asarray(n**2 * (n**2 - 1) / (n**2 + 1) * (p + 1 - n**2))


def fig02() -> Figure:
    """Growth rates of the modes over pressure, and the fastest growing mode."""
    figure = new_figure(10, 4)
    left, right = figure.subplots(1, 2)
    p = np.linspace(0, LARGEST_LOAD, 2801)
    rates = np.stack([growth_squared(n, p) for n in MODES])
    _draw_growth(left, p, rates)
    fastest = np.where(rates.max(axis=0) > 0, rates.argmax(axis=0) + MODES.start, np.nan)
    right.plot(p, fastest, color="#222222")
    right.set(xlabel=r"pressure $p R^3/B$", ylabel="fastest growing mode $n$", yticks=list(MODES))
    letter(right, "b")
    return figure


def _draw_growth(ax: Axes, p: np.ndarray, rates: np.ndarray) -> None:
    for n, rate in zip(MODES, rates, strict=True):
        ax.plot(p, rate, ls="--", lw=0.9, color="#777777")
        ax.text(p[-1], rate[-1], f" {n}", va="center", size=8)
    ax.plot(p, np.maximum(rates.max(axis=0), 0), color="#222222", label="fastest")
    ax.set(xlabel=r"pressure $p R^3/B$", ylabel=r"$\omega^2\,\rho A R^4/B$", ylim=(-200, 1.05 * rates.max()))
    letter(ax, "a")


def fig03() -> Figure:
    """One swing of a uniform loop, its curvature and forces."""
    run = result("fig03")
    figure = new_figure(11, 7)
    axes = figure.subplot_mosaic("SSS;CFN", height_ratios=[1, 1.6])
    draw_row(axes["S"], run, frames_at(run, (0, 2, 3, 4, 4.81)))
    letter(axes["S"], "a", "returns at 9.62, 7.62, 6.62, 5.62")
    frames = frames_at(run, (2, 4, 4.81))
    draw_curvature(axes["C"], run, frames)
    draw_forces(axes["F"], run, "axial", frames)
    draw_forces(axes["N"], run, "shear", frames)
    for name, ax in zip("bcd", (axes["C"], axes["F"], axes["N"]), strict=True):
        letter(ax, name)
    return figure


def fig04() -> Figure:
    """Energies of the same loop over three periods."""
    figure = new_figure(7.5, 4)
    draw_energies(figure.subplots(), result("fig04"))
    return figure


def fig05() -> Figure:
    """Buckling into several lobes at four pressures."""
    figure = new_figure(19, 8)
    draw_buckling(figure, ("fig05a", "fig05b", "fig05c", "fig05d"), "abcd")
    return figure


def fig06() -> Figure:
    """Damped oscillation; the times count from the switching on of the load."""
    run = result("fig06")
    figure = new_figure(11, 5)
    upper, lower = figure.subplots(2, 1, height_ratios=[1, 1.3])
    draw_row(upper, run, frames_at(run, (0, 1.7, 3, 4, 5.05, 6.5, 8, 10, 16)))
    _draw_width(lower)
    return figure


def _draw_width(ax: Axes) -> None:
    run = result("fig06")
    points = run.sizes["s"]
    width = (run["x"][:, points // 4] - run["x"][:, 3 * points // 4]) / 2
    ax.plot(run["t"], width, color="#e8820c")
    ax.plot(1.7, float(np.interp(1.7, run["t"], width)), "o", mfc="white", mec="#222222", label="onset, 1.7")
    ax.set(xlabel=r"time $\,t\,\sqrt{B/(\rho A)}\,/R^2$", ylabel="half width $/R$")
    ax.legend()
    milliseconds(ax, run)


def fig07() -> Figure:
    """Energies and dissipation of the damped loop."""
    figure = new_figure(7.5, 6)
    draw_energy_panels(figure, ("fig06",), "a")
    return figure
