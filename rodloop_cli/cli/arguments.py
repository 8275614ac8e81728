"""Arguments and options that several commands share."""

from __future__ import annotations

import click

case_file = click.argument("case_path", metavar="CASE", type=click.Path(path_type=str))

overrides = click.option(
    "--set",
    "overrides",
    metavar="KEY=VALUE",
    multiple=True,
    help="Set one key, as in p=4 or perturbation.0.amplitude=1e-3; an empty value removes it. Repeatable.",
)
