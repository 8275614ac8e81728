"""Critical loads in words and as a table."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rodloop_cli.critical.curves import Grid, Outcome
    from rodloop_cli.critical.loads import CriticalLoads

MEANING = (
    "p_alpha is the pressure of a finite loss of area; only p_stability marks a loss of stability, "
    "and a loop of two stiffnesses deforms smoothly from p = 0 on, whatever p_alpha is."
)


def in_words(loads: CriticalLoads) -> list[str]:
    """The three measures side by side, what else the branch tells, and one sentence on what they mean."""
    lines = [
        f"p_alpha      {loads.p_alpha:.7g}   least bending energy at area alpha A0, alpha = {loads.alpha:.6g}",
        f"p_limit      {loads.p_limit:.7g}   the same for alpha to 1",
        f"p_stability  {_stability(loads)}",
    ]
    if loads.p_soft is not None:
        lines.append(f"p_soft       {loads.p_soft:.7g}   1 % of the slowest motion's squared frequency is left")
    if loads.p_contact is not None:
        lines.append(f"p_contact    {loads.p_contact:.7g}   self-contact; the branch beyond is not physical")
    return [*lines, MEANING]


def _stability(loads: CriticalLoads) -> str:
    if loads.p_stability is None:
        return f"none         stable from p = 0 to {loads.p_searched:.6g}"
    beyond = loads.p_contact is not None and abs(loads.p_contact) < abs(loads.p_stability)
    return f"{loads.p_stability:.7g}   {loads.stability_kind}" + (", beyond self-contact" if beyond else "")


def as_table(grid: Grid, outcomes: Sequence[Outcome]) -> list[str]:
    """One line a rod."""
    lines = [f"{'alpha':>10} {'B2/B1':>10} {'k':>8} {'p_alpha':>12} {'p_limit':>10} {'p_stability':>12}"]
    points = product(grid.alpha, grid.stiffness_ratio, grid.k)
    for (alpha, ratio, k), outcome in zip(points, outcomes, strict=True):
        start = f"{alpha:10.6g} {ratio:10.6g} {k:8.4g}"
        if isinstance(outcome, str):
            lines.append(f"{start}  {outcome}")
            continue
        threshold = "none" if outcome.p_stability is None else f"{outcome.p_stability:.6g}"
        lines.append(f"{start} {outcome.p_alpha:12.7g} {outcome.p_limit:10.5g} {threshold:>12}")
    return lines
