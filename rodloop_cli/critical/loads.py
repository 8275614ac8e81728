"""All critical loads of one rod, side by side."""

from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from rodloop_cli.critical.fourier import DEFAULT_MODES, fourier_pressure
from rodloop_cli.critical.measure import bracket_of, compressibility, limit
from rodloop_cli.physics.rod import Rod
from rodloop_cli.stability.threshold import Kind, Stability, find_threshold
from rodloop_cli.statics.loaded import at_zero_load

Method = Literal["boxes", "fourier"]

PAPER_ALPHA = 0.9999
CELLS = 12
"""Of six Gauss points each, for contrasts up to some ten: p(α) to ten digits, thresholds of deep shapes to five."""

P_MAX = 10.0

SOFT = 0.01


@dataclass(frozen=True)
class Search:
    """What to compute: α of the measure, by which method (with how many sine modes), how far to follow the branch, on
    how many cells.
    """

    alpha: float = PAPER_ALPHA
    p_max: float = P_MAX
    method: Method = "boxes"
    modes: int = DEFAULT_MODES
    cells: int = CELLS
    until_contact: bool = False


@dataclass(frozen=True)
class CriticalLoads:
    """Critical pressures p R³/B1 of one rod; None where there is none.

    p_alpha: multiplier of least energy at area α A0;  p_limit: its limit for α → 1;  compressibility: -(dA/dp)/A at p =
    0; p_stability: load at which the branch from p = 0 loses stability, ``stability_kind`` how;  p_soft: where the
    slowest motion has kept 1 % of its -λ² at p = 0, the mark of an imperfect bifurcation;  p_contact: where the loop on
    the branch touches itself; p_searched: end of the search.
    """

    alpha: float
    p_alpha: float
    p_limit: float
    compressibility: float
    p_stability: float | None
    stability_kind: Kind | None
    p_soft: float | None
    p_contact: float | None
    p_searched: float

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def critical_loads(rod: Rod, search: Search) -> CriticalLoads:
    """Compute them all. Raises ConvergenceError where a branch cannot be followed."""
    start = at_zero_load(rod, search.cells)
    bracket = bracket_of(start, search.alpha)
    p_alpha = bracket.at(search.alpha * start.area).p
    if search.method == "fourier":
        p_alpha = fourier_pressure(rod, search.alpha, search.modes)
    stability = find_threshold(start, search.p_max, until_contact=search.until_contact)
    threshold = stability.threshold
    return CriticalLoads(
        alpha=search.alpha,
        p_alpha=p_alpha,
        p_limit=limit(start, search.alpha),
        compressibility=compressibility(start),
        p_stability=threshold.p if threshold else None,
        stability_kind=threshold.kind if threshold else None,
        p_soft=soft_of(stability),
        p_contact=stability.p_contact,
        p_searched=min(float(stability.p[-1]), search.p_max, key=abs),
    )


def soft_of(stability: Stability) -> float | None:
    """The first load at which the largest λ² has come within SOFT of zero, measured by its value at p = 0."""
    left = stability.square / stability.square[0]
    below = np.flatnonzero(left <= SOFT)
    if not len(below):
        return None
    i = int(below[0])
    return float(np.interp(-SOFT, -left[i - 1 : i + 1], stability.p[i - 1 : i + 1]))
