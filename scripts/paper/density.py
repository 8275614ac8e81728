"""Figs. 15 to 17: loops with a denser half."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rodloop_cli.plot import draw_energies
from scripts.paper.panels import draw_buckling, draw_row, evenly, frames_at, letter, name_fates, new_figure, title_of
from scripts.paper.results import result

NAMED = (0, 8.5, 10.6, 11.5, 12.3, 13.8, 14.4, 22.7, 23.4, 24.1)
"""Times that the paper names."""


def fig15() -> Figure:
    """The two halves of a loop with a denser half lose step, and meet again."""
    run = result("fig15")
    figure = new_figure(13, 9)
    shapes, swings, energies = figure.subplots(3, 1, height_ratios=[0.8, 1, 1])
    draw_row(shapes, run, frames_at(run, NAMED))
    letter(shapes, "a")
    _draw_swings(swings)
    draw_energies(energies, run)
    letter(swings, "b")
    return figure


def _draw_swings(ax: Axes) -> None:
    run = result("fig15")
    points = run.sizes["s"]
    ax.plot(run["t"], run["x"][:, points // 4], color="#e8820c", label="$x$ at $s = L/4$")
    ax.plot(run["t"], run["x"][:, 3 * points // 4], color="#7b3fa0", label="$x$ at $s = 3L/4$")
    for time in NAMED[1:]:
        ax.axvline(time, color="#d9d9d9", lw=0.8, zorder=0)
    ax.set(xlim=(0, 26), ylabel="$x/R$")
    ax.legend(ncols=2)


def fig16() -> Figure:
    """Buckling of a loop with a denser half at four pressures."""
    figure = new_figure(19, 8)
    draw_buckling(figure, tuple(f"fig16{panel}" for panel in "abcd"), "abcd")
    return figure


def fig17() -> Figure:
    """Stiffness and density contrast together: shapes at two density ratios and four pressures."""
    figure = new_figure(15, 8)
    for ax, panel in zip(figure.subplots(4, 2).T.flat, "abcdefgh", strict=True):
        run = result(f"fig17{panel}")
        draw_row(ax, run, evenly(run), marks=True)
        letter(ax, panel, title_of(run))
    name_fates(figure)
    return figure
