"""Drawings of linear stability: dispersion curves, the most unstable mode, mode shapes; and of critical pressures."""

from __future__ import annotations

from collections.abc import Iterator

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rodloop_cli.case.wording import one_line
from rodloop_cli.errors import OutputError
from rodloop_cli.plot.options import Options
from rodloop_cli.plot.sweep_axes import hatch

Array = npt.NDArray[np.float64]

PRESSURE = r"pressure $\,\tilde p = p R^3/B_1$"
RATIO = r"stiffness ratio $\,B_2/B_1$"
SHAPES = 8
"""Mode shapes in a figure."""
SWING = 0.25
"""Largest displacement of a drawn mode, in R."""
LETTER = 0.035
"""Height of a number, in the range of the axes."""
WIDE = 4.0
"""Ratios that span more than this are drawn on a logarithmic axis."""
RATIO_TICKS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
OUTLINE, MODE, MIRROR = "#9a9a9a", "#1f6fb4", "#e8820c"


# -- figures


def modes_overview(dataset: xr.Dataset, options: Options) -> Figure:
    """Dispersion curves and the most unstable mode over the pressure; the shapes where there is one pressure."""
    if dataset.sizes["p"] == 1:
        return mode_shapes(dataset, options)
    figure = Figure(figsize=options.size or (10.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    draw_dispersion(left, dataset)
    draw_most_unstable(right, dataset)
    return _headed(figure, dataset)


def mode_shapes(dataset: xr.Dataset, options: Options) -> Figure:
    """The first modes at the last pressure, each about its base state."""
    count = min(SHAPES, dataset.sizes["mode"])
    columns = min(4, count)
    rows = -(-count // columns)
    figure = Figure(figsize=options.size or (2.6 * columns, 2.9 * rows), layout="constrained")
    for i, ax in enumerate(figure.subplots(rows, columns, squeeze=False).ravel()):
        if i < count:
            draw_mode(ax, dataset, i)
        else:
            ax.set_axis_off()
    return _headed(figure, dataset)


def critical_curves(dataset: xr.Dataset, options: Options) -> Figure:
    """p(α) over the stiffness ratio, and where stability is really lost."""
    figure = Figure(figsize=options.size or (10.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    draw_critical(left, dataset)
    draw_thresholds(right, dataset)
    return _headed(figure, dataset)


def critical_map(dataset: xr.Dataset, options: Options) -> Figure:
    """Which loops lose stability before they touch themselves."""
    if min(dataset.sizes["stiffness_ratio"], dataset.sizes["k"]) < 2:
        raise OutputError("a map needs several stiffness ratios and several k")
    figure = Figure(figsize=options.size or (7.4, 4.8), layout="constrained")
    draw_stability_map(figure.subplots(), dataset)
    return _headed(figure, dataset)


# -- modes


def draw_dispersion(ax: Axes, dataset: xr.Dataset) -> None:
    """λ² over the pressure for each number of lobes, and the envelope of the fastest growing, as in Fig. 2a."""
    p, squares = _numbers(dataset, "p"), _squares(dataset)
    lobes = _numbers(dataset, "lobes").astype(int)
    shown = sorted(set(lobes[squares > 0].tolist())) or sorted(set(lobes[:, 0].tolist()))
    colours = mpl.colormaps["viridis"](np.linspace(0, 0.9, len(shown)))
    for n, colour in zip(shown, colours, strict=True):
        for curve in _curves_of(squares, lobes, n):
            ax.plot(p, curve, "--", lw=1.0, color=colour)
    top = squares[:, 0]
    _name_ends(ax, p, {n: next(_curves_of(squares, lobes, n)) for n in shown}, LETTER * float(np.ptp(top)))
    ax.plot(p, top, color="#222222", lw=1.8, label="fastest growing")
    largest = float(top.max()) if top.max() > 0 else 1.0
    ax.set(xlim=(p.min(), p.max()), ylim=(-0.15 * largest, 1.08 * largest), xlabel=PRESSURE)
    ax.set_ylabel(r"squared growth rate $\,\mathrm{Re}\,\lambda^2$")
    ax.axhline(0, color="#777777", lw=0.7)
    ax.legend(loc="upper left")


def draw_most_unstable(ax: Axes, dataset: xr.Dataset) -> None:
    """Lobes of the fastest growing mode over the pressure, as in Fig. 2b; a gap where nothing grows."""
    p, growing = _numbers(dataset, "p"), _numbers(dataset, "growth_rate")[:, 0] > 0
    lobes = np.where(growing, _numbers(dataset, "lobes")[:, 0], np.nan)
    ax.step(p, lobes, where="mid", color=MODE, lw=1.8)
    ax.set(xlim=(p.min(), p.max()), xlabel=PRESSURE, ylabel="lobes of the fastest growing mode")
    ax.yaxis.set_major_locator(MaxNLocator(integer=True))
    if not growing.any():
        ax.text(0.5, 0.5, "nothing grows", transform=ax.transAxes, ha="center")


def draw_mode(ax: Axes, dataset: xr.Dataset, mode: int = 0, p: int = -1) -> None:
    """The base state, and the loop displaced along a mode (counted from 0) one way and the other; `p`: index."""
    at = dataset.isel(p=p, mode=mode)
    base = np.stack([_numbers(at, "x"), _numbers(at, "y")])
    swing = SWING * np.stack([_numbers(at, "displacement_x"), _numbers(at, "displacement_y")])
    for shape, colour, width in ((base - swing, MIRROR, 0.9), (base, OUTLINE, 0.9), (base + swing, MODE, 1.6)):
        ax.plot(*np.concatenate([shape, shape[:, :1]], axis=1), color=colour, lw=width)
    ax.plot(*base[:, 0], ".", color="#222222", ms=5)
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.set_title(f"{mode + 1}: {_rate_words(at)}\n{int(at['lobes'])} lobes", loc="center")


def _rate_words(at: xr.Dataset) -> str:
    growth, frequency = float(at["growth_rate"]), float(at["frequency"])
    parts = [f"{growth:.4g}" if growth or not frequency else "", f"{frequency:.4g} i" if frequency else ""]
    return r"$\lambda$ = " + " + ".join(part for part in parts if part)


def _squares(dataset: xr.Dataset) -> Array:
    growth, frequency = _numbers(dataset, "growth_rate"), _numbers(dataset, "frequency")
    squares: Array = growth**2 - frequency**2
    return squares


def _curves_of(squares: Array, lobes: npt.NDArray[np.int_], n: int) -> Iterator[Array]:
    """(P,): the largest λ² of n lobes at every pressure, then the second largest; NaN where there is none."""
    of_n = -np.sort(-np.where(lobes == n, squares, -np.inf), axis=1)[:, :2]
    for column in np.where(np.isfinite(of_n), of_n, np.nan).T:
        if np.isfinite(column).any():
            yield column


def _name_ends(ax: Axes, p: Array, curves: dict[int, Array], height: float) -> None:
    """The number of lobes at the right end of each curve; numbers closer than a letter's ``height`` share a place."""
    places: list[tuple[float, float, list[int]]] = []
    ends = {n: int(np.flatnonzero(np.isfinite(curve))[-1]) for n, curve in curves.items()}
    for n in sorted(curves, key=lambda n: curves[n][ends[n]]):
        x, y = float(p[ends[n]]), float(curves[n][ends[n]])
        if places and places[-1][0] == x and y - places[-1][1] < height:
            places[-1][2].append(n)
        else:
            places.append((x, y, [n]))
    for x, y, names in places:
        words = ", ".join(map(str, sorted(names)))
        ax.annotate(words, (x, y), xytext=(3, 0), textcoords="offset points", size=8, va="center")


# -- critical pressures


def draw_critical(ax: Axes, dataset: xr.Dataset) -> None:
    """p(α) over the stiffness ratio for each k (and α), with the fit (19) for k = 1/2, as in Fig. 8."""
    ratio = _numbers(dataset, "stiffness_ratio")
    lines = [(float(a), float(k)) for a in dataset["alpha"] for k in dataset["k"]]
    colours = mpl.colormaps["viridis"](np.linspace(0, 0.9, len(lines)))
    for (alpha, k), colour in zip(lines, colours, strict=True):
        values = dataset["p_alpha"].sel(alpha=alpha, k=k).to_numpy()
        label = f"$k$ = {k:g}" + (rf", $\alpha$ = {alpha:g}" if dataset.sizes["alpha"] > 1 else "")
        ax.plot(ratio, values, ".-", ms=3, lw=1.2, color=colour, label=label)
    if (np.abs(dataset["k"].to_numpy() - 0.5) < 1e-9).any():
        fine = np.linspace(ratio.min(), ratio.max(), 400)
        ax.plot(fine, fit_19(fine), color="#222222", lw=0.9, ls="--", label="Eq. (19)")
    ax.set(xlabel=RATIO, ylabel=r"$p(\alpha)\,R^3/B_1$", xlim=(ratio.min(), ratio.max()), ylim=(0, None))
    words = "" if dataset.sizes["alpha"] > 1 else rf", $\alpha$ = {float(dataset['alpha'][0]):g}"
    ax.set_title(f"least bending energy at a given area{words}")
    ax.legend()


def draw_thresholds(ax: Axes, dataset: xr.Dataset) -> None:
    """Where the equilibria from p = 0 lose stability, over the stiffness ratio; nothing where they do not."""
    ratio, fractions = _numbers(dataset, "stiffness_ratio"), _numbers(dataset, "k")
    colours = mpl.colormaps["viridis"](np.linspace(0, 0.9, len(fractions)))
    lost = _lost_before_contact(dataset)
    contact = dataset["p_contact"].where(lost.isnull())
    for i, colour in enumerate(colours):
        ax.plot(ratio, lost.isel(k=i), "o-", ms=3, lw=1.0, color=colour, label=f"$k$ = {fractions[i]:g}")
        ax.plot(ratio, contact.isel(k=i), "x", ms=4, color=colour)
    ax.plot([], [], "x", color="#777777", label="self-contact before any loss")
    ax.set(xlabel=RATIO, ylabel=PRESSURE, xlim=(ratio.min(), ratio.max()), ylim=(0, None))
    ax.set_title("loss of stability")
    ax.legend()


def draw_stability_map(ax: Axes, dataset: xr.Dataset) -> None:
    """Pressure of the loss of stability over ratio and k, in units of the softer segment; hatched where there is none.
    Pressure of the loss of stability over ratio and k, in units of the softer segment; hatched where there is none.
    """
    ratio, k = _numbers(dataset, "stiffness_ratio"), _numbers(dataset, "k")
    threshold = _lost_before_contact(dataset).transpose("k", "stiffness_ratio").to_numpy()
    softer = np.minimum(1.0, ratio)
    values = np.ma.masked_invalid(threshold / softer)
    scale = "log" if ratio.max() / ratio.min() > WIDE else "linear"
    edges = _edges(ratio, scale), _edges(k, "linear")
    drawn = ax.pcolormesh(*edges, values, cmap="viridis", rasterized=True)
    hatch(ax, edges, np.ma.getmaskarray(values))
    ax.grid(visible=False)
    _scale_ratios(ax, ratio, scale)
    figure = ax.get_figure(root=True)
    assert figure is not None
    figure.colorbar(drawn, ax=ax, label=r"$p_{\mathrm{stability}}\,R^3/\min(B_1, B_2)$")
    ax.set(xlabel=RATIO, ylabel="fraction $k$ of segment 1")
    ax.set_title("loss of stability; hatched: none before the loop touches itself")


def _lost_before_contact(dataset: xr.Dataset) -> xr.DataArray:
    """Pressure of the loss of stability where the loop does not touch itself before; else NaN."""
    lost, contact = dataset["p_stability"], dataset["p_contact"]
    return lost.where(contact.isnull() | (np.abs(contact) > np.abs(lost)))


def _edges(points: Array, scale: str) -> Array:
    """(n + 1,): half-way between points, in the logarithm on a logarithmic axis."""
    if scale == "log":
        edges: Array = np.exp(_edges(np.log(points), "linear"))
        return edges
    middle = (points[:-1] + points[1:]) / 2
    return np.concatenate([[2 * points[0] - middle[0]], middle, [2 * points[-1] - middle[-1]]])


def _scale_ratios(ax: Axes, ratio: Array, scale: str) -> None:
    ax.set_xscale(scale)
    if scale == "log":
        ticks = [t for t in RATIO_TICKS if ratio.min() <= t <= ratio.max()]
        ax.set_xticks(ticks, [f"{t:g}" for t in ticks])
        ax.minorticks_off()


def fit_19(ratio: Array) -> Array:
    """6 sqrt(q)/(q⁶ + q⁻⁶), q = B2/B1: the paper's fit of p(0.9999) for k = 1/2."""
    fit: Array = 6 * np.sqrt(ratio) / (ratio**6 + ratio**-6.0)
    return fit


def _numbers(dataset: xr.Dataset, name: str) -> Array:
    return np.asarray(dataset[name].to_numpy(), dtype=np.float64)


def _headed(figure: Figure, dataset: xr.Dataset) -> Figure:
    pressures = f", p = {float(dataset['p'][0]):g}" if "p" in dataset.dims and dataset.sizes["p"] == 1 else ""
    figure.suptitle(one_line(str(dataset.attrs.get("title", ""))) + pressures, parse_math=False)
    return figure
