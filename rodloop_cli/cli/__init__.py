"""The command line. Commands live in modules of their own and are imported when they are called."""

from __future__ import annotations

import os
from collections.abc import Sequence

import click

from rodloop_cli import __version__
from rodloop_cli.cli.lazy import Entry, LazyGroup
from rodloop_cli.cli.outcome import exit_code
from rodloop_cli.cli.settings import Settings

COMMANDS = {
    "run": Entry("rodloop_cli.cli.run:run", "Simulate a case and write its motion to a netCDF file."),
    "plot": Entry("rodloop_cli.cli.plot:plot", "Draw a result file as a figure or a movie."),
    "sweep": Entry("rodloop_cli.cli.sweep:sweep", "Run a case over a grid of parameters."),
    "critical": Entry("rodloop_cli.cli.critical:critical", "Critical loads of the static equilibria."),
    "modes": Entry("rodloop_cli.cli.modes:modes", "Natural modes and growth rates about an equilibrium."),
    "check": Entry("rodloop_cli.cli.check:check", "Check a case file and show it with all defaults filled in."),
    "new": Entry("rodloop_cli.cli.new:new", "Write a commented case file to start from."),
    "schema": Entry("rodloop_cli.cli.schema:schema", "Print the JSON Schema of case files, for editors."),
}


@click.group(
    cls=LazyGroup,
    table=COMMANDS,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Start with 'rodloop new', then 'rodloop run case.yaml', then 'rodloop plot case.nc'.",
)
@click.version_option(__version__, "-V", "--version", prog_name="rodloop")
def rodloop() -> None:
    """Dynamics of a closed elastic rod in a soap film."""


def main(args: Sequence[str] | None = None) -> int:
    """Run the command line (of the process if no arguments are given); returns the exit code."""
    settings = Settings()
    # click itself does not know https://no-color.org; None leaves it to decide by the terminal.
    color = False if os.environ.get("NO_COLOR") else None

    def command() -> object:
        return rodloop.main(args, prog_name="rodloop", standalone_mode=False, obj=settings, color=color)

    return exit_code(command, settings)
