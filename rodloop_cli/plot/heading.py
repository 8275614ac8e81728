"""The words around a figure: its title, how the run ended, its parameters."""

from __future__ import annotations

import textwrap
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from rodloop_cli.case import Case, parse_case
from rodloop_cli.case.wording import one_line
from rodloop_cli.dataset.provenance import GOOD_ENDS
from rodloop_cli.errors import CaseError
from rodloop_cli.plot.data import times
from rodloop_cli.plot.frames import crossing_time, sound
from rodloop_cli.plot.look import ALARM

LETTERS_PER_INCH = 11
"""Of the bold title, with some room."""


def head(figure: Figure, dataset: xr.Dataset) -> None:
    """Title over the figure, parameters and outcome under it; a run without a proper end says so in the title."""
    width = max(int(figure.get_figwidth() * LETTERS_PER_INCH), 20)
    trouble = trouble_of(dataset)
    lines = [_fitted(title_of(dataset), width, 2), *([_fitted(trouble, width, 3)] if trouble else [])]
    # Texts from the file: a stray $ must not be read as mathematics.
    figure.suptitle("\n".join(lines), color=ALARM if trouble else "black", parse_math=False)
    foot = "     ".join(
        filter(None, [*parameters_of(dataset), crossing_of(dataset), "" if trouble else outcome_of(dataset)])
    )
    figure.supxlabel(_fitted(foot, int(1.2 * width), 2), color="#555555", parse_math=False)


def title_of(dataset: xr.Dataset) -> str:
    """The case's title, else the name of the file."""
    source = dataset.encoding.get("source")
    return one_line(str(dataset.attrs.get("title", ""))) or (Path(source).name if source else "rodloop run")


def outcome_of(dataset: xr.Dataset) -> str:
    """How the run ended, as a sentence; empty if it did not."""
    return one_line(str(dataset.attrs.get("outcome", "")))


def trouble_of(dataset: xr.Dataset) -> str:
    """What the title must say of a run that did not end as it should."""
    outcome, reached = outcome_of(dataset), times(dataset)[-1]
    if not outcome:
        return f"UNFINISHED RUN: rows up to t = {reached:.4g}"
    return "" if outcome.startswith(GOOD_ENDS) else f"FAILED RUN, rows up to t = {reached:.4g}: {outcome}"


def crossing_of(dataset: xr.Dataset) -> str:
    """When the loop crossed itself, if there are frames after that."""
    limit = crossing_time(dataset)
    return f"crosses itself after t = {limit:.4g}" if limit is not None and not sound(dataset).all() else ""


def parameters_of(dataset: xr.Dataset) -> list[str]:
    """The numbers of the case that matter; none if the case cannot be read."""
    try:
        case = parse_case(str(dataset.attrs.get("case", "")))
    except CaseError:
        return []
    drag = [f"ζ⊥ = {case.zeta_perp:.4g}", f"γ = {case.gamma:.4g}"] if case.zeta_perp else []
    load = f"p R³/B₁ = {case.p:.4g}".replace("-", "−")
    return [load, *_ratios(case), *drag]


def _ratios(case: Case) -> list[str]:
    if len(case.segments) != 2:
        return [f"{len(case.segments)} segments"] if len(case.segments) > 2 else []
    first, second = case.segments
    return [
        *([f"B₂/B₁ = {second.stiffness:.4g}"] if second.stiffness != 1 else []),
        *([f"ρ₂/ρ₁ = {second.density:.4g}"] if second.density != 1 else []),
        *([f"k = {first.fraction:.4g}"] if first.fraction != 0.5 else []),
    ]


def _fitted(text: str, width: int, lines: int) -> str:
    return textwrap.fill(text, width, max_lines=lines, placeholder=" …")
