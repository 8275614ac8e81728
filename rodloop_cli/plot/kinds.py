"""What can be drawn of which file: the one table that the command line goes by. Imports nothing heavy.

A file says what it is by the global attribute `rodloop_content`; without it, it is the result of a run. To draw a new
sort of file, give its entry in `CONTENTS` an opener and kinds: the first kind is what is drawn if none is asked for.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from rodloop_cli.case.wording import did_you_mean, one_line
from rodloop_cli.errors import OutputError
from rodloop_cli.plot.formats import FIGURES, MOVIES

MOVIE = "movie"

CONTENT_ATTRIBUTE = "rodloop_content"
RUN = "run"


@dataclass(frozen=True)
class Kind:
    """`target`: ``package.module:function`` of (dataset, options); returns a Figure, or a Movie for `MOVIES`."""

    target: str
    words: str
    formats: tuple[str, ...] = FIGURES


@dataclass(frozen=True)
class Content:
    """`opener`: ``package.module:function``, called with the path; it returns a Dataset or raises OutputError."""

    opener: str
    kinds: Mapping[str, Kind]


CONTENTS: Mapping[str, Content] = {
    RUN: Content(
        "rodloop_cli.plot.file:open_any_run",
        {
            "overview": Kind("rodloop_cli.plot.figures:overview", "shapes, energies, forces, displacements"),
            "shapes": Kind("rodloop_cli.plot.figures:shapes", "shapes over each other and one by one"),
            "energies": Kind("rodloop_cli.plot.figures:energies", "energy changes and their balance"),
            "forces": Kind("rodloop_cli.plot.figures:forces", "axial and shear force along the loop"),
            "curvature": Kind("rodloop_cli.plot.figures:curvature", "curvature along the loop"),
            "kymograph": Kind("rodloop_cli.plot.figures:kymograph", "curvature over arclength and time"),
            "displacement": Kind("rodloop_cli.plot.figures:displacement", "how the segments' midpoints swing"),
            "dissipation": Kind("rodloop_cli.plot.figures:dissipation", "power and energy taken by the film"),
            MOVIE: Kind("rodloop_cli.plot.moving:movie", "the shape and its energies, moving", MOVIES),
        },
    ),
    "sweep": Content(
        "rodloop_cli.plot.sweep:open_summary",
        {
            "overview": Kind("rodloop_cli.plot.sweep:overview", "lines over one axis, maps over two"),
            "lines": Kind("rodloop_cli.plot.sweep:lines", "what was found, over the longest axis"),
            "maps": Kind("rodloop_cli.plot.sweep:maps", "phase diagram of lobes, and times of first crossing"),
            "phases": Kind("rodloop_cli.plot.sweep:phases", "phase diagram of lobes"),
            "shapes": Kind("rodloop_cli.plot.sweep:shapes", "final shapes of the members, each at its place"),
        },
    ),
    "modes": Content(
        "rodloop_cli.dataset.stability_files:open_table",
        {
            "overview": Kind("rodloop_cli.plot.stability:modes_overview", "growth over pressure, or mode shapes"),
            "shapes": Kind("rodloop_cli.plot.stability:mode_shapes", "the fastest growing modes"),
        },
    ),
    "critical": Content(
        "rodloop_cli.dataset.stability_files:open_table",
        {
            "overview": Kind(
                "rodloop_cli.plot.stability:critical_curves", "critical pressures over the stiffness ratio"
            ),
            "maps": Kind("rodloop_cli.plot.stability:critical_map", "which loops lose stability"),
        },
    ),
}


def all_kinds() -> list[str]:
    """Every name that some sort of file knows, each once."""
    return list(dict.fromkeys(name for content in CONTENTS.values() for name in content.kinds))


def check_name(name: str | None) -> None:
    """Raises OutputError for a kind that no sort of file has; None stands for the first kind of the file."""
    if name is not None and name not in all_kinds():
        raise OutputError(f"--kind: unknown kind '{one_line(name, 40)}'{_instead(name, all_kinds())}")


def kind_of(content: str, name: str | None) -> Kind:
    """The kind called `name`, or the first one, of a sort of file."""
    kinds = CONTENTS[content].kinds
    if not kinds:
        raise OutputError(f"there is no drawing of a {content} file in this version")
    if name is not None and name not in kinds:
        raise OutputError(f"--kind: a {content} file has no '{one_line(name, 40)}'{_instead(name, list(kinds))}")
    return kinds[name or next(iter(kinds))]


def load(target: str) -> Any:
    """The function behind ``package.module:function``."""
    module, _, function = target.partition(":")
    return getattr(import_module(module), function)


def _instead(name: str, choices: list[str]) -> str:
    return did_you_mean(name, choices) or f"; choose from {', '.join(choices)}"
