"""Energies and dissipation over time."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from rodloop_cli.plot.axes import legend_above, plot_in_time, time_axis
from rodloop_cli.plot.data import Array, values
from rodloop_cli.plot.look import INK


class Energy(NamedTuple):
    """One term of the balance; None of the colours is that of a segment."""

    variable: str
    symbol: str
    colour: str


ENERGIES = (
    Energy("bending_energy", r"$\Delta E_b$", "#1a1a1a"),
    Energy("surface_energy", r"$\Delta E_t$", "#c8371d"),
    Energy("kinetic_energy", r"$E_k$", "#009988"),
    Energy("dissipated_energy", r"$E_d$", "#a8a020"),
)


def draw_energies(ax: Axes, dataset: xr.Dataset) -> None:
    """Changes of the energies since the first frame; the legend says how far their sum strays from zero."""
    for energy in shown(dataset):
        plot_in_time(ax, dataset, change(dataset, energy), color=energy.colour, label=energy.symbol)
    residual = values(dataset, "energy_residual")
    label = rf"$|\Sigma|\leq${scientific(float(np.abs(residual).max()))}"
    ax.plot(values(dataset, "t"), residual, color="#777777", lw=0.9, ls=":", label=label)
    time_axis(ax, dataset)
    ax.set_ylabel(r"energy change $\,/\,(B_1/R)$")
    legend_above(ax, columns=5)


def draw_residual(ax: Axes, dataset: xr.Dataset) -> None:
    """The sum of all energies minus its first value: zero in the exact motion, so the error that the run made."""
    plot_in_time(ax, dataset, values(dataset, "energy_residual"), color=INK, label="residual")
    time_axis(ax, dataset, says_why=False)
    ax.set_ylabel(r"sum $\Sigma\,/\,(B_1/R)$")


def draw_dissipation(ax: Axes, dataset: xr.Dataset) -> None:
    """The power that the film takes from the loop."""
    rate = values(dataset, "dissipation_rate")
    plot_in_time(ax, dataset, rate, color=INK, label=r"dissipation rate $P_d$")
    time_axis(ax, dataset)
    ax.set_ylabel(r"$P_d\,R^3\sqrt{\rho_1 A}\,/B_1^{3/2}$")
    ax.set_ylim(bottom=0)
    legend_above(ax)
    if not rate.any():
        ax.text(0.5, 0.5, "no drag: nothing is dissipated", transform=ax.transAxes, ha="center", color="#555555")


def shown(dataset: xr.Dataset) -> list[Energy]:
    """The energies that are worth a line: without drag none is dissipated."""
    damped = values(dataset, "dissipated_energy").any()
    return [energy for energy in ENERGIES if damped or energy.variable != "dissipated_energy"]


def change(dataset: xr.Dataset, energy: Energy) -> Array:
    """(t,): since the first frame."""
    stored = values(dataset, energy.variable)
    return np.asarray(stored - stored[0])


def scientific(value: float) -> str:
    r"""``$1.6\times10^{-4}$``."""
    if value == 0:
        return "$0$"
    mantissa, _, exponent = f"{value:.1e}".partition("e")
    return rf"${mantissa}\times10^{{{int(exponent)}}}$"
