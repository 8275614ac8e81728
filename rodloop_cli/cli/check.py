"""``rodloop check``: is a case file valid, and what does it mean."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from rodloop_cli.cli.arguments import case_file, overrides

if TYPE_CHECKING:
    from rodloop_cli.case import Case


@click.command()
@case_file
@overrides
def check(case_path: str, overrides: tuple[str, ...]) -> None:
    """Check CASE and print it with every default filled in, itself a case file.

    Everything that is wrong is listed, one line each, and the exit code is 2.
    """
    from rodloop_cli.case import load_case

    case = load_case(case_path, overrides)
    click.echo(f"# {click.format_filename(case_path)} is valid.")
    click.echo(case.to_yaml() + "\n".join(f"# {line}" for line in summary(case)))


def summary(case: Case) -> list[str]:
    """What the keys amount to, a line each."""
    times, count = case.times, len(case.segments)
    segments = [
        f"segment {i}: {part.fraction:.6g} of the loop, stiffness {part.stiffness:g}, density {part.density:g}"
        for i, part in enumerate(case.segments, start=1)
    ]
    return [
        *(segments if count > 1 else ["one material all around"]),
        f"{len(times)} stored times from {times[0]:g} to {times[-1]:g}, {case.output_points} points each",
        f"sha256 {case.sha256}",
    ]
