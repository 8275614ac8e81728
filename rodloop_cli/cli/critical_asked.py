"""Which rods ``rodloop critical`` is asked about: options, a case file, or a grid."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rodloop_cli.errors import CaseError

if TYPE_CHECKING:
    from rodloop_cli.case import Document
    from rodloop_cli.critical.curves import Grid
    from rodloop_cli.physics.rod import Rod

Values = tuple[float, ...]
Options = Mapping[str, Values | None]

DEFAULTS = {"stiffness_ratio": (1.0,), "k": (0.5,), "alpha": (0.9999,)}
WIDEST = 1e6
"""Stiffness ratios beyond this, or below its inverse, leave too few digits."""

RULES: Mapping[str, tuple[str, Callable[[float], bool]]] = {
    "stiffness_ratio": (f"must be from {1 / WIDEST:g} to {WIDEST:g}", lambda v: 1 / WIDEST <= v <= WIDEST),
    "k": ("must be between 0 and 1", lambda v: 0 < v < 1),
    "alpha": ("must be positive and not 1", lambda v: v > 0 and v != 1),
}


@dataclass(frozen=True)
class Asked:
    """A grid of two-segment rods (of one point, mostly), or the rod of a case, which may have any segments."""

    grid: Grid
    rod: Rod | None = None


def asked(path: str | None, options: Options) -> Asked:
    """Raises CaseError with everything that is wrong, one line each."""
    if path is None:
        return Asked(_grid({}, options))
    from rodloop_cli.case import open_document

    document = open_document(path)
    if isinstance(document.values, dict) and "grid" in document.values:
        return Asked(_grid(_axes(document), options))
    return _of_case(document, path, options)


def _of_case(document: Document, path: str, options: Options) -> Asked:
    from rodloop_cli.case import case_from
    from rodloop_cli.simulation.start import rod_of

    case = case_from(document)
    given = [f"--{name.replace('_', '-')}".replace("--k", "-k") for name in ("stiffness_ratio", "k") if options[name]]
    if given:
        raise CaseError([f"{path}: gives the rod already; leave out {' and '.join(given)}, or the file"])
    rod_values = {"stiffness_ratio": (case.stiffness_ratio or 1.0,), "k": (case.k or 0.5,)}
    return Asked(_grid(rod_values, options), rod_of(case))


def _axes(document: Document) -> dict[str, Values]:
    """The axes of a sweep file's grid, as far as they matter here."""
    from rodloop_cli.case.fault import Problem
    from rodloop_cli.sweep.axes import axis_of

    problems: list[Problem] = []
    axes: dict[str, Values] = {}
    grid = document.values["grid"]
    for key in grid if isinstance(grid, dict) else ():
        if key not in DEFAULTS:
            problems.append(Problem(document.place(("grid", key)), f"grid.{key}: must be one of {', '.join(DEFAULTS)}"))
        elif axis := axis_of(document, ("grid", key), problems):
            axes[key] = tuple(point[0] for point in axis.points)
            if not axis.is_numeric:
                problems.append(Problem(document.place(("grid", key)), f"grid.{key}: must hold numbers"))
    if problems or not axes:
        raise CaseError([f"{p.place}: {p.what}" for p in problems] or ["grid: must be a mapping with values"])
    return axes


def _grid(base: Mapping[str, Values], options: Options) -> Grid:
    from rodloop_cli.critical.curves import Grid

    values = {name: options[name] or base.get(name) or default for name, default in DEFAULTS.items()}
    wrong = [
        f"{name}: {what} (got {value!r})"
        for name, (what, holds) in RULES.items()
        for value in values[name]
        if not holds(value)
    ]
    if wrong:
        raise CaseError(wrong)
    return Grid(**{name: tuple(float(v) for v in given) for name, given in values.items()})
