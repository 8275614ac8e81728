"""``rodloop plot``: a result file to a figure or a movie."""

from __future__ import annotations

from pathlib import Path

import click
from click.shell_completion import CompletionItem

from rodloop_cli.cli.settings import current_settings


def _complete_kind(_context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[CompletionItem]:
    from rodloop_cli.plot.kinds import CONTENTS

    named = [item for content in CONTENTS.values() for item in content.kinds.items()]
    kinds = {name: kind.words for name, kind in reversed(named)}  # those of runs are what is said of a shared name
    return [CompletionItem(name, help=words) for name, words in kinds.items() if name.startswith(incomplete)]


@click.command()
@click.argument("path", metavar="FILE.nc", type=click.Path(path_type=str))
@click.option("--kind", metavar="KIND", shell_complete=_complete_kind, help="What to draw (default: overview).")
@click.option("-o", "--output", metavar="OUT", help="Figure or movie (default: the name of FILE with .png or .gif).")
@click.option("--times", metavar="T1,T2,...", help="Draw the stored frames nearest to these times.")
@click.option("--fps", type=float, default=25.0, show_default=True, help="Frames per second of a movie.")
@click.option("--dpi", type=float, help="Pixels per inch (default: 150, movies 100).")
@click.option("--size", metavar="WxH", help="Width and height in inches, as in 10x8.")
def plot(
    path: str, kind: str | None, output: str | None, times: str | None, fps: float, dpi: float | None, size: str | None
) -> None:
    """Draw FILE.nc, or what an unfinished run left of it, and print the path of the drawing.

    \b
    Kinds, of a run:
      overview      shapes, energies, forces, displacements
      shapes        shapes over each other and one by one
      energies      energy changes and their balance
      forces        axial and shear force along the loop
      curvature     curvature along the loop
      kymograph     curvature over arclength and time
      displacement  how the segments' midpoints swing
      dissipation   power and energy taken by the film
      movie         the shape and its energies, moving
    of a sweep's summary, sweep.nc:
      overview      lines over one axis, maps over two
      lines         what was found, over the longest axis
      maps          phase diagram of lobes, and times of first crossing
      phases        phase diagram of lobes
      shapes        final shapes of the members, each at its place
    of what rodloop modes wrote:
      overview      growth over pressure, or mode shapes
      shapes        the fastest growing modes
    of what rodloop critical wrote:
      overview      critical pressures over the stiffness ratio
      maps          which loops lose stability

    Figures are png, svg or pdf, movies gif, html or mp4 (needs ffmpeg: pip install 'rodloop[movie]'). An older
    drawing of the name is replaced. Frames after the loop has crossed itself are not physics: they are grey and
    dashed, such times are hatched.
    """  # noqa: D301  \b is click's own mark
    from rodloop_cli.plot.options import Options, read_size, read_times

    options = Options(times=read_times(times), size=read_size(size), dpi=dpi, fps=fps)

    from rodloop_cli.plot.file import plot_file

    drawn = plot_file(Path(path), kind, Path(output) if output else None, options, _tell)
    click.echo(str(drawn))


def _tell(words: str) -> None:
    if not current_settings().quiet:
        click.echo(words, err=True)
