"""``rodloop critical``: critical pressures of the static equilibria, for one rod or a grid of them."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from rodloop_cli.cli.critical_asked import Asked, asked
from rodloop_cli.cli.critical_progress import item_bar
from rodloop_cli.cli.critical_words import as_table, in_words
from rodloop_cli.cli.values import numbers
from rodloop_cli.errors import ConvergenceError, OutputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rodloop_cli.critical.curves import Outcome
    from rodloop_cli.critical.loads import Search

FARTHEST = 1000.0
"""Pressure up to which eigenvalues stand out from round-off: near -5000 it looks like a loss of stability."""

AXES = ("stiffness_ratio", "k", "alpha")


@click.command()
@click.argument("path", metavar="[FILE]", required=False, type=click.Path(path_type=str))
@click.option("--stiffness-ratio", metavar="B2/B1", callback=numbers, help="Of the two segments (default: 1).")
@click.option("--density-ratio", type=float, metavar="RATIO", help="Accepted, but statics knows no density.")
@click.option("-k", metavar="K", callback=numbers, help="Fraction of the arclength in segment 1 (default: 0.5).")
@click.option("--alpha", metavar="ALPHA", callback=numbers, help="Area over that at p = 0 (default: 0.9999).")
@click.option("--p-max", default=10.0, show_default=True, help="Follow the equilibria to here, of either sign.")
@click.option("--method", type=click.Choice(["boxes", "fourier"]), default="boxes", help="For p_alpha.")
@click.option("-M", "modes", default=40, show_default=True, type=click.IntRange(4, 400), help="Sine modes of fourier.")
@click.option("--cells", default=12, show_default=True, type=click.IntRange(4, 200), help="Cells around the loop.")
@click.option("-j", "--jobs", default=2, show_default=True, type=click.IntRange(1), help="Processes for a grid.")
@click.option("-o", "--output", metavar="OUT.nc", help="Write the numbers to this file.")
@click.option("-f", "--force", is_flag=True, help="Replace the file if it exists.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def critical(path: str | None, output: str | None, force: bool, as_json: bool, jobs: int, **options: Any) -> None:
    """Critical pressures p R^3/B1 of a rod loop, three of them side by side.

    \b
    p_alpha      pressure that holds the loop of least bending energy at area alpha A0
    p_limit      its limit for alpha to 1
    p_stability  pressure at which the equilibria that start at p = 0 become unstable

    FILE is a case, or a sweep file with a grid over stiffness_ratio, k and alpha. Options with several values, as in
    --stiffness-ratio 0.15:6:40 -k 0.47,0.5,0.53, make a grid too; they take the place of FILE's.
    """  # noqa: D301  \b is click's own mark
    if not 0 < abs(options["p_max"]) <= FARTHEST:
        raise click.BadParameter(f"must be between -{FARTHEST:g} and {FARTHEST:g}, and not 0", param_hint="--p-max")
    if options["density_ratio"] is not None and not options["density_ratio"] > 0:
        raise click.BadParameter("must be positive", param_hint="--density-ratio")
    what = asked(path, {name: options[name] for name in AXES})

    from rodloop_cli.critical.loads import Search

    search = Search(p_max=options["p_max"], method=options["method"], modes=options["modes"], cells=options["cells"])
    if output:
        _check(Path(output), what, force=force)
    if len(what.grid) > 1:
        _of_grid(what, search, jobs, output, as_json=as_json)
    else:
        _of_one(what, search, output, as_json=as_json)


def _check(path: Path, what: Asked, *, force: bool) -> None:
    from rodloop_cli.dataset.writer import check_target

    check_target(path, force=force)
    if what.rod is not None and len(what.rod.segments) > 2:
        raise OutputError(f"{path}: a file holds loops of two segments, over stiffness ratio and k; use --json")


def _of_one(what: Asked, search: Search, output: str | None, *, as_json: bool) -> None:
    from threadpoolctl import threadpool_limits

    from rodloop_cli.critical.curves import two_segments
    from rodloop_cli.critical.loads import critical_loads

    grid = what.grid
    rod = what.rod or two_segments(grid.stiffness_ratio[0], grid.k[0])
    with threadpool_limits(1):  # the matrices are small
        loads = critical_loads(rod, replace(search, alpha=grid.alpha[0]))
    written = _written(output, what, [loads])
    if as_json:
        click.echo(json.dumps(loads.as_dict() | ({"path": written} if written else {})))
    else:
        click.echo("\n".join([*in_words(loads), *([written] if written else [])]))


def _of_grid(what: Asked, search: Search, jobs: int, output: str | None, *, as_json: bool) -> None:
    from rodloop_cli.critical.curves import over_grid

    if what.rod is not None and len(what.rod.segments) > 2:
        raise OutputError("a loop of more than two segments takes one alpha at a time")
    outcomes: list[Outcome] = []
    with item_bar(len(what.grid), "rod") as advance:
        for outcome in over_grid(what.grid, search, jobs):
            outcomes.append(outcome)
            advance()
    written = _written(output, what, outcomes)
    failed = sum(isinstance(outcome, str) for outcome in outcomes)
    if as_json:
        rods = [
            {"stiffness_ratio": ratio, "k": k}
            | ({"alpha": alpha, "error": outcome} if isinstance(outcome, str) else outcome.as_dict())
            for (alpha, ratio, k), outcome in zip(what.grid.points, outcomes, strict=True)
        ]
        click.echo(json.dumps({"rods": rods, "failed": failed, "path": written}))
    else:
        click.echo(written or "\n".join(as_table(what.grid, outcomes)))
    if failed:
        raise ConvergenceError(f"{failed} of {len(outcomes)} rods could not be computed")


def _written(output: str | None, what: Asked, outcomes: Sequence[Outcome]) -> str | None:
    if output is None:
        return None
    from rodloop_cli.dataset.stability_columns import critical_columns
    from rodloop_cli.dataset.stability_files import CRITICAL, write_table

    columns = critical_columns(what.grid, outcomes)
    return str(write_table(Path(output), CRITICAL, columns, {"title": "Critical pressures"}, force=True))
