"""``rodloop run``: one case to one result file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rodloop_cli.cli.arguments import case_file, overrides
from rodloop_cli.cli.settings import current_settings

if TYPE_CHECKING:
    from rodloop_cli.simulation import Summary


@click.command()
@case_file
@click.option("-o", "--output", metavar="OUT.nc", help="Result file (default: the case's name with .nc, here).")
@overrides
@click.option("-f", "--force", is_flag=True, help="Replace the result file if it exists.")
@click.option("--json", "as_json", is_flag=True, help="Print what the run found as one JSON object.")
def run(case_path: str, output: str | None, overrides: tuple[str, ...], force: bool, as_json: bool) -> None:
    """Simulate CASE and write its motion to a netCDF file, whose path is printed."""
    from rodloop_cli.case import load_case

    case = load_case(case_path, overrides)
    path = Path(output) if output else Path(Path(case_path).stem + ".nc")

    from rodloop_cli.cli.progress import time_bar
    from rodloop_cli.dataset.writer import RunWriter
    from rodloop_cli.simulation import Run

    prepared = Run.of(case)
    recorder = prepared.recorder
    with (
        RunWriter(path, s=recorder.s, segment=recorder.segment, attributes=prepared.attributes, force=force) as writer,
        time_bar(case.t_end) as progress,
    ):
        summary = prepared.into(writer, progress)
    if not current_settings().quiet:
        click.echo("\n".join(told(summary)), err=True)
    click.echo(json.dumps(found(summary, path)) if as_json else str(path))


def told(summary: Summary) -> list[str]:
    """The end of a run in words."""
    work = summary.work
    lines = [summary.outcome]
    if summary.extrema.minima:
        time, area = summary.extrema.minima[0]
        lines.append(f"first area minimum {area:.6g} at t = {time:.6g}")
    if summary.extrema.period is not None:
        lines.append(f"period {summary.extrema.period:.6g} (between minima of the area)")
    share = summary.energy_residual / summary.energy_change if summary.energy_change else 0.0
    lines.append(f"energy residual {summary.energy_residual:.1e}, {share:.1e} of the largest change")
    lines.append(
        f"{work.steps} steps ({work.rejected} rejected, {work.newton_failures} failed), {summary.cells} cells, "
        f"{summary.wall_seconds:.2f} s"
    )
    return lines


def found(summary: Summary, path: Path) -> dict[str, object]:
    """The end of a run for other programs."""
    return {"path": str(path), "outcome": summary.outcome, **summary.findings, **summary.totals}
