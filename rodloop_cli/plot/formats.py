"""The formats of figures and movies, and whether one can be written here. Imports nothing heavy."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path

from rodloop_cli.case.wording import did_you_mean, one_line
from rodloop_cli.errors import OutputError

FIGURES = ("png", "svg", "pdf")
MOVIES = ("gif", "mp4", "html")
"""The first of each is the default."""


def format_of(path: Path) -> str:
    """``png`` for figure.PNG."""
    return path.suffix[1:].lower()


def check_format(target: Path, allowed: Sequence[str]) -> None:
    """Raises OutputError unless the target's suffix is an allowed format that can be written here."""
    wanted, known = format_of(target), (*FIGURES, *MOVIES)
    if wanted not in known:
        guess = did_you_mean(wanted, known) or f" (figures: {', '.join(FIGURES)}; movies: {', '.join(MOVIES)})"
        raise OutputError(f"{target}: unknown format '{one_line(wanted, 20)}'{guess}")
    if wanted not in allowed:
        raise OutputError(f"{target}: this kind cannot be written as {wanted}; choose from {', '.join(allowed)}")
    if wanted == "mp4" and ffmpeg() is None:
        raise OutputError(f"{target}: mp4 needs ffmpeg: pip install 'rodloop[movie]', or choose .gif or .html")


def ffmpeg() -> str | None:
    """The program that writes mp4: of the extra `movie`, else of the system; None if there is none."""
    try:
        import imageio_ffmpeg  # noqa: PLC0415  an extra

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        return shutil.which("ffmpeg")
