"""From a file to a file: what ``rodloop plot`` does."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import netCDF4

from rodloop_cli.case.wording import one_line
from rodloop_cli.dataset.reader import open_run
from rodloop_cli.dataset.writer import check_target
from rodloop_cli.errors import OutputError
from rodloop_cli.plot import kinds
from rodloop_cli.plot.formats import MOVIES, check_format, format_of
from rodloop_cli.plot.options import Options

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from rodloop_cli.plot.moving import Movie

Tell = Callable[[str], None]


def plot_file(
    path: Path,
    kind: str | None = None,
    output: Path | None = None,
    options: Options | None = None,
    tell: Tell | None = None,
) -> Path:
    """Draw a result file; returns where the drawing is. `tell` hears which stored times were drawn.

    Raises OutputError for whatever is wrong with the file, the kind, the output or the data.
    """
    if kind is None and output is not None and format_of(output) in MOVIES:
        kind = kinds.MOVIE
    kinds.check_name(kind)
    content = content_of(path)
    chosen = kinds.kind_of(content, kind)
    target = output or Path(f"{_stem(path)}.{chosen.formats[0]}")
    check_format(target, chosen.formats)
    check_target(target, force=True)
    with kinds.load(kinds.CONTENTS[content].opener)(path) as dataset:
        _draw(dataset, chosen, target, options or Options(), tell or (lambda _: None))
    return target


def content_of(path: Path) -> str:
    """Which sort of file it is, a key of `CONTENTS`; "run" for whatever cannot be read: its opener has the words."""
    if not path.is_file():
        return kinds.RUN
    try:
        with netCDF4.Dataset(path) as raw:
            content = str(getattr(raw, kinds.CONTENT_ATTRIBUTE, kinds.RUN))
    except (OSError, RuntimeError, ValueError, AttributeError):
        return kinds.RUN
    if content not in kinds.CONTENTS:
        raise OutputError(f"{path} holds '{one_line(content, 40)}', which this version cannot draw")
    return content


def open_any_run(path: Path) -> xr.Dataset:
    """A result, finished or not."""
    return open_run(path, partial=True)


def _draw(dataset: xr.Dataset, kind: kinds.Kind, target: Path, options: Options, tell: Tell) -> None:
    from rodloop_cli.plot.look import style  # noqa: PLC0415  matplotlib takes a second

    if options.times:
        tell(f"drawn at the stored times nearest to those asked for: {_stored(dataset, options)}")
    with style():
        _save(kinds.load(kind.target)(dataset, options), target, options)


def _stored(dataset: xr.Dataset, options: Options) -> str:
    from rodloop_cli.plot.data import times  # noqa: PLC0415
    from rodloop_cli.plot.frames import nearest  # noqa: PLC0415

    return ", ".join(f"{time:.6g}" for time in times(dataset)[nearest(dataset, options.times)])


def _save(drawn: Figure | Movie, target: Path, options: Options) -> None:
    from matplotlib.figure import Figure  # noqa: PLC0415

    if isinstance(drawn, Figure):
        from rodloop_cli.plot.output import save_figure  # noqa: PLC0415

        save_figure(drawn, target, options.dpi)
    else:
        from rodloop_cli.plot.encode import save_movie  # noqa: PLC0415

        save_movie(drawn, target, options.fps)


def _stem(path: Path) -> str:
    """``case`` for case.nc and case.nc.part."""
    return path.name.removesuffix(".part").removesuffix(".nc") or "rodloop"
