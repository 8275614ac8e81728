"""``rodloop run``: one case to one result file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rodloop_cli.cli.arguments import case_file, overrides
from rodloop_cli.cli.settings import current_settings
from rodloop_cli.errors import ConvergenceError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rodloop_cli.simulation import Run, Summary


@click.command()
@case_file
@click.option("-o", "--output", metavar="OUT.nc", help="Result file (default: the case's name with .nc, here).")
@overrides
@click.option("-f", "--force", is_flag=True, help="Replace the result file if it exists.")
@click.option("--resume", is_flag=True, help="Continue a run that was killed; start it if there is none.")
@click.option("--json", "as_json", is_flag=True, help="Print what the run found as one JSON object.")
def run(
    case_path: str, output: str | None, overrides: tuple[str, ...], force: bool, resume: bool, as_json: bool
) -> None:
    """Simulate CASE and write its motion to a netCDF file, whose path is printed."""
    from rodloop_cli.case import load_case

    case = load_case(case_path, overrides)
    path = Path(output) if output else Path(Path(case_path).stem + ".nc")

    from rodloop_cli.dataset.reader import result_of
    from rodloop_cli.dataset.writer import check_target

    if resume and not force and path.exists() and (known := result_of(path, case.sha256)):
        finished(path, known, as_json=as_json)
        return
    check_target(path, force=force)

    from rodloop_cli.numerics.allocator import keep_freed_memory
    from rodloop_cli.simulation import Run

    keep_freed_memory()
    prepared = Run.of(case)
    beforehand = [prepared.warning] if prepared.warning else []
    warn(beforehand)
    summary = simulated(prepared, path, force=force, resume=resume)
    if not current_settings().quiet:
        click.echo("\n".join(told(summary)), err=True)
    warn(summary.warnings)
    numbers = found(summary, path) | {"warnings": beforehand + summary.warnings}
    click.echo(json.dumps(numbers) if as_json else str(path))


def finished(path: Path, known: Mapping[str, Any], *, as_json: bool) -> None:
    """Say what a result file holds that a run was to continue. Raises ConvergenceError if that run had failed."""
    from rodloop_cli.dataset.provenance import GOOD_ENDS

    if not known["outcome"].startswith(GOOD_ENDS):
        raise ConvergenceError(f"{path} is of a run that failed: {known['outcome']} (--force starts it again)")
    click.echo(f"{path} is finished already", err=True)
    numbers = {name.removeprefix("total_"): value.item() for name, value in known.items() if hasattr(value, "item")}
    warnings = [known["warning"]] if "warning" in known else []
    told = {"path": str(path), "outcome": known["outcome"], **numbers, "warnings": warnings}
    click.echo(json.dumps(told) if as_json else str(path))


def warn(texts: list[str]) -> None:
    """Say them, however quiet the command is to be."""
    for text in texts:
        click.echo(f"warning: {text}", err=True)


def simulated(run: Run, path: Path, *, force: bool, resume: bool) -> Summary:
    """Run to the end, with a progress bar and checkpoints."""
    from rodloop_cli.cli.progress import time_bar
    from rodloop_cli.dataset.checkpoint import checkpoint_path
    from rodloop_cli.dataset.writer import RunWriter
    from rodloop_cli.simulation.resume import Keeper, resumed, signals_to

    recorder = run.recorder
    rows = resumed(path, run) if resume else 0
    lost = not rows and checkpoint_path(path).exists()
    writer = RunWriter(
        path, s=recorder.s, segment=recorder.segment, attributes=run.attributes, force=force, resume=rows
    )
    if lost:
        why = "is damaged, or of another case or version of rodloop" if resume else "is not used without --resume"
        warn([f"{checkpoint_path(path)} {why}: starting again"])
    run.revisit(writer.stored())
    keeper = Keeper(writer, run)
    try:
        with writer, time_bar(run.case.t_end) as progress, signals_to(keeper):
            summary = run.into(writer, progress, keeper)
    except ConvergenceError as error:
        keeper.done()  # its file is closed; there is nothing to continue
        raise ConvergenceError(f"{error}\nthe rows before that are in {path}") from error
    keeper.done()
    return summary


def told(summary: Summary) -> list[str]:
    """The end of a run in words."""
    work = summary.work
    lines = [summary.outcome]
    minima = summary.extrema.prominent_minima()
    if minima:
        time, area = minima[0]
        lines.append(f"first area minimum {area:.6g} at t = {time:.6g}")
    if summary.extrema.period is not None:
        lines.append(f"period {summary.extrema.period:.6g} (between minima of the area)")
    share = "of rounding" if summary.residual_is_noise else f"{summary.lost_share:.1e} of the largest change"
    lines.append(f"energy residual {summary.energy_residual:.1e}, {share}")
    lines.append(
        f"{work.steps} steps ({work.rejected} rejected, {work.newton_failures} failed), {summary.cells} cells, "
        f"{summary.seconds:.2f} s"
    )
    return lines


def found(summary: Summary, path: Path) -> dict[str, object]:
    """The end of a run for other programs."""
    return {"path": str(path), "outcome": summary.outcome, **summary.findings, **summary.totals}
