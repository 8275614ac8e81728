"""``rodloop new``: a case file to start from."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import click

from rodloop_cli.errors import OutputError


@click.command()
@click.argument("path", metavar="[FILE]", default="case.yaml", type=click.Path(path_type=str, allow_dash=True))
@click.option("-f", "--force", is_flag=True, help="Overwrite FILE if it exists.")
def new(path: str, force: bool) -> None:
    """Write a commented case file to FILE (default: case.yaml; - for stdout)."""
    template = files("rodloop_cli.case").joinpath("template.yaml").read_text(encoding="utf-8")
    if path == "-":
        click.echo(template, nl=False)
        return
    _write(Path(path), template, mode="w" if force else "x")
    click.echo(path)


def _write(path: Path, text: str, mode: str) -> None:
    try:
        with path.open(mode, encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        remedy = "use another name, or -f to overwrite it"
        raise OutputError(f"{click.format_filename(path)}: exists already; {remedy}") from None
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise OutputError(f"{click.format_filename(path)}: cannot be written: {reason}") from None
