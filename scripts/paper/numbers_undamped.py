"""Reproduction of the undamped motion: periods, durations and lobes, the times of Fig. 15."""

from __future__ import annotations

from math import nan

import numpy as np
import xarray as xr

from scripts.paper import measures
from scripts.paper.homogeneous import MODES, growth_squared
from scripts.paper.markdown import Lines, compared, paragraph, row, section, table
from scripts.paper.results import result

PRESSURES = (16, 32, 64, 128)
SEEDS = range(1, 9)
SMALL = 1e-3
"""Amplitude below which the first lobes to be seen are those that grew, not those that were drawn."""

MIRRORED = 5.0
"""Time before and after the mirror time of Fig. 15 over which the motion is compared."""


def periods() -> Lines:
    """Figs. 3 and 9."""
    yield from section("Periods (Figs. 3, 4, 9, 10)")
    yield from table("quantity", "paper", "ours", "difference", "why")
    uniform, stiff = result("fig03"), result("fig09")
    half = uniform.attrs["first_area_minimum_time"]
    yield compared("period, uniform, p = 3.8", 9.62, 2 * half, "amplitude 4.68e-3 chosen for it")
    yield compared(
        "half period, ratio 5, p = 3.8", 1.125, stiff.attrs["first_area_minimum_time"], "minimum of the area"
    )
    why = "between two minima of the area; waves from the junctions keep it from being strictly periodic"
    yield compared("period, ratio 5", 2.25, stiff.attrs["period"], why)
    yield from _period_by_amplitude()


def _period_by_amplitude() -> Lines:
    yield "\nTwice the time of the first minimum of the area, uniform loop, p = 3.8, mode 2:"
    yield from table("amplitude ε", "scheme", "period")
    for amplitude in (1e-2, 5e-3, 4.68e-3, 1e-3):
        run = result("fig03", f"perturbation.0.amplitude={amplitude}", "snapshots=2")
        yield row(f"{amplitude:g}", "radau, tol 1e-6", f"{2 * run.attrs['first_area_minimum_time']:.4f}")
    for points in (60, 100):
        options = ("scheme=bdf2", "tol=", f"N={points}", "dt=0.01", "t_end=5.2", "snapshots=2")
        run = result("fig03", "perturbation.0.amplitude=5e-3", *options)
        yield row("0.005", f"bdf2, N = {points}, Δt = 0.01", f"{2 * run.attrs['first_area_minimum_time']:.4f}")
    yield paragraph(
        """
        The linear growth rate 1.3856 of mode 2 predicts a shift of -2 ln(ε ratio)/1.3856. The paper's 9.62 follows
        from ε = 4.68e-3, or from ε = 5e-3 with its own scheme on a coarse grid of about 60 points: it states
        neither.
        """
    )


def durations() -> Lines:
    """Figs. 5, 11 and 16."""
    yield from section("Durations and lobes at high pressure (Figs. 5, 11, 16)")
    yield paragraph(
        """
        The paper ends each sequence at its most deformed shape. The model has no contact, so no sequence can go on
        past the first self-crossing. Lobes are counted at the paper's time, or at the crossing if that is earlier;
        those lost are counted once the shape strays from a circle visibly.
        """
    )
    yield from table("panel", "p", "paper's duration", "our first crossing", "paper/ours", "lobes then", "lobes lost")
    ends = {
        "fig05": (1.125, 0.63, 0.308, 0.189),
        "fig11abcd": (0.675, 0.36, 0.224, 0.14),
        "fig11efgh": (0.45, 0.315, 0.168, 0.12),
        "fig16": (1.5, 0.72, 0.364, 0.2),
    }
    for name, times in ends.items():
        panels = name[5:] or "abcd"
        for panel, p, time in zip(panels, PRESSURES, times, strict=True):
            yield _duration(f"{name[:5]}{panel}", p, time)


def _duration(name: str, p: int, time: float) -> str:
    run = result(name, f"t_end={2 * time}", "snapshots=301")
    crossing = measures.crossing(run)
    fates = str(run.attrs.get("lobe_event_fates", "")).split()
    lost = ", ".join(f"{fates.count(fate)} {fate}" for fate in ("coalescence", "collapse") if fate in fates) or "none"
    end = min(time, crossing)
    return row(name, p, time, f"{crossing:.4g}", f"{time / crossing:.2f}", measures.lobes_at(run, end), lost)


def seeds() -> Lines:
    """How Fig. 5 depends on the perturbation that the paper does not state."""
    yield "\nFig. 5 over seeds 1 to 8 (lobes at the paper's time, or at the crossing if that is earlier):"
    paper = dict(zip(PRESSURES, ((1.125, 3, 3), (0.63, 4, 4), (0.308, 6, 5), (0.189, 8, 6)), strict=True))
    yield from table(
        "p",
        "ε",
        "first crossing",
        "paper's time",
        "lobes when visible",
        "Eq. (17), paper",
        "lobes later",
        "paper",
        "lost by",
    )
    for letter, p in zip("abcd", PRESSURES, strict=True):
        for amplitude in (5e-3, 5e-5):
            yield _over_seeds(f"fig05{letter}", p, amplitude, *paper[p])
    yield paragraph(
        """
        The paper's times fit ε = 5e-3, also at p = 64, where Appendix C assigns Fig. 5c the amplitude 5e-5: from
        that amplitude the loop, displaced inextensibly, is still nearly round at 0.308. Each factor of 10 in ε
        costs ln 10/ω. The number of lobes when they become visible is that of the fastest growing mode or of a
        neighbour, whose rate is nearly the same: the draw decides. From 5e-3 the first shapes still show the draw
        itself, so no number is given there. The number left in the end is the paper's for most seeds.
        """
    )


def _over_seeds(name: str, p: int, amplitude: float, time: float, first: int, later: int) -> str:
    runs = [_drawn(name, amplitude, seed, time) for seed in SEEDS]
    crossings = [measures.crossing(run) for run in runs]
    small = amplitude < SMALL
    visible = [measures.lobes_when_visible(run) for run in runs] if small else []
    left = [] if small else [measures.lobes_at(run, time) for run in runs]
    fastest = max(MODES, key=lambda n: float(growth_squared(n, np.array(float(p)))))
    assert fastest == first
    spread = f"{min(crossings):.3g}-{max(crossings):.3g}"
    return row(p, f"{amplitude:g}", spread, time, _counts(visible), first, _counts(left), later, _fates(runs))


def _drawn(name: str, amplitude: float, seed: int, time: float) -> xr.Dataset:
    settings = (f"perturbation.0.random.amplitude={amplitude}", f"perturbation.0.random.seed={seed}")
    return result(name, *settings, f"t_end={3 * time}", "snapshots=301", "tol=1e-3")


def _fates(runs: list[xr.Dataset]) -> str:
    """How many lobes were lost in which way, over all runs, up to the crossing."""
    fates = " ".join(str(run.attrs.get("lobe_event_fates", "")) for run in runs).split()
    return ", ".join(f"{fates.count(fate)} {fate}" for fate in sorted(set(fates))) or "-"


def _counts(numbers: list[int]) -> str:
    """``5 (6 of 8), 4 (2 of 8)``, the most frequent first."""
    values = sorted(set(numbers), key=lambda value: (-numbers.count(value), value))
    return ", ".join(f"{value} ({numbers.count(value)} of {len(numbers)})" for value in values) or "-"


def asynchrony() -> Lines:
    """Fig. 15."""
    yield from section("Times of Fig. 15 (density ratio 5)")
    yield from table("ε", "orange turns", "purple turns", "mirror time near 23.4", "mismatch there")
    for amplitude in (5e-3, 2e-3, 1e-3):
        yield _asynchrony(amplitude)
    yield paragraph(
        """
        At 8.5 in the paper the light half rebounds and the heavy one still contracts, to pause shortly after: the
        light half turns before 8.5 and the heavy one after it, which is ε = 2e-3. About 23.4 the motion nearly
        retraces itself. A factor in ε shifts all times alike. The mirror time is the one about which the swings
        within ±5 differ least from their mirror images; the mismatch is the mean difference, over R.
        """
    )


def _asynchrony(amplitude: float) -> str:
    run = result("fig15", f"perturbation.0.amplitude={amplitude}", "t_end=30", "snapshots=601")
    t, x, points = run["t"].to_numpy(), run["x"].to_numpy(), run.sizes["s"]
    swings = x[:, [points // 4, 3 * points // 4]]
    turns = [next(time for time in measures.turning_points(t, swing) if time > 4) for swing in swings.T]
    mirror, mismatch = _mirror(t, swings)
    return row(f"{amplitude:g}", *(f"{time:.2f}" for time in turns), f"{mirror:.2f}", f"{mismatch:.3f}")


def _mirror(t: np.ndarray, swings: np.ndarray) -> tuple[float, float]:
    """The time between 20 and 25 about which the swings (t, 2) are most nearly even, and how nearly."""
    reach = round(MIRRORED / (t[1] - t[0]))
    best = (nan, np.inf)
    for i in np.flatnonzero((t > 20) & (t < 25)):
        apart = float(np.abs(swings[i : i + reach] - swings[i : i - reach : -1]).mean())
        best = min(best, (float(t[i]), apart), key=lambda found: found[1])
    return best
