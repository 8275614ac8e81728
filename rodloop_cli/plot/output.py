"""Where a drawing goes: the path, its format, and a file that is whole or not there."""

from __future__ import annotations

import contextlib
import os
import warnings
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure

from rodloop_cli.dataset.failures import writing
from rodloop_cli.errors import OutputError
from rodloop_cli.plot.formats import format_of
from rodloop_cli.plot.look import style

DPI = 150.0
_NO_DATE: dict[str, dict[str, str | None]] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {}}
"""The same file gives the same bytes."""


def save_figure(figure: Figure, path: Path, dpi: float | None) -> None:
    """Write a figure in the format of the path's suffix, replacing what is there."""
    form = format_of(path)
    picture = BytesIO()
    with style(), drawing():
        figure.savefig(picture, format=form, dpi=dpi or DPI, metadata=_NO_DATE[form])
    with replacing(path) as new:
        new.write_bytes(picture.getbuffer())


@contextlib.contextmanager
def drawing() -> Iterator[None]:
    """Around whatever makes matplotlib draw: its warnings are passed over or become OutputError."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing", UserWarning)  # a title in a script that the font has not
        warnings.filterwarnings("error", "constrained_layout not applied", UserWarning)
        try:
            yield
        except UserWarning:
            raise OutputError("--size: too small for what must be drawn; give more (an overview needs 8x7)") from None


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A path beside `path` to write to, put in its place at the end; nothing is left of it after an error."""
    new = path.with_name(f".{path.name}.{os.getpid()}.part")
    with writing(path, lambda: ""):
        try:
            yield new
            new.replace(path)
        finally:
            with contextlib.suppress(OSError):
                new.unlink(missing_ok=True)
