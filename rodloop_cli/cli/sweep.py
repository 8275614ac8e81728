"""``rodloop sweep``: a case over a grid of parameters."""

from __future__ import annotations

import json
import re
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rodloop_cli.cli.arguments import overrides
from rodloop_cli.cli.settings import current_settings
from rodloop_cli.errors import SweepError

if TYPE_CHECKING:
    from rodloop_cli.sweep.plan import Shard
    from rodloop_cli.sweep.run import Sweep, Watcher


def _share(context: click.Context, parameter: click.Parameter, text: str | None) -> Shard | None:
    """``2/8``: the second of eight equal shares."""
    if text is None:
        return None
    from rodloop_cli.sweep.plan import Shard

    match = re.fullmatch(r"(\d{1,9})/(\d{1,9})", text)
    if not match or not 1 <= int(match[1]) <= int(match[2]):
        raise click.BadParameter(f"must be i/n with i from 1 to n, as in 2/8 (got {text})", context, parameter)
    return Shard(int(match[1]), int(match[2]))


@click.command()
@click.argument("grid_path", metavar="GRID", type=click.Path(path_type=str))
@click.option("-o", "--output", metavar="DIR", help="Folder of the results (default: the name of GRID, here).")
@click.option("-j", "--jobs", metavar="N", default=2, show_default=True, type=click.IntRange(1), help="Processes.")
@overrides
@click.option("-n", "--dry-run", is_flag=True, help="List the members that would run, and stop.")
@click.option("--executor", type=click.Choice(["process", "dask", "mpi"]), default="process", help="Who runs them.")
@click.option("--scheduler", metavar="ADDRESS", help="Of a dask cluster, as in tcp://host:8786.")
@click.option(
    "--shard", metavar="I/N", callback=_share, help="Run only this share of the members, as one job of an array."
)
@click.option("--json", "as_json", is_flag=True, help="Print the numbers of members as one JSON object.")
def sweep(
    grid_path: str,
    output: str | None,
    jobs: int,
    overrides: tuple[str, ...],
    dry_run: bool,
    executor: str,
    scheduler: str | None,
    shard: Shard | None,
    as_json: bool,
) -> None:
    """Run the case of GRID over its grid; each member to a file in DIR, the scalars of all to DIR/sweep.nc.

    Repeating the command runs only what is not done: after a kill, after failures, after a change of the grid.
    Keys of the base case can be set with --set, and those of GRID too, as in --set 'grid.p=[16, 32]'.
    """
    if scheduler and executor != "dask":
        raise click.UsageError("--scheduler goes with --executor dask.")
    from rodloop_cli.sweep.run import Sweep

    clock = time.perf_counter()
    folder = output or Path(grid_path).stem
    prepared = Sweep.of(grid_path, folder, overrides, shard, read_only=dry_run)
    if dry_run:
        _list(prepared)
        return
    if prepared.replaced:
        words = "results there are of other cases and will be replaced, each when the new one is complete"
        click.echo(f"{folder}: {prepared.replaced} {words}", err=True)
    try:
        with _member_bar(prepared) as watcher:
            prepared.run(executor, jobs, scheduler, watcher)
    except SweepError:
        _tell(prepared, clock, as_json)
        raise
    _tell(prepared, clock, as_json)


def _list(prepared: Sweep) -> None:
    for member in prepared.to_run:
        click.echo(member.name)
    if not current_settings().quiet:
        click.echo(f"{len(prepared.to_run)} of {len(prepared.plan.members)} members would run", err=True)


def _tell(prepared: Sweep, clock: float, as_json: bool) -> None:
    tally, path = prepared.tally, prepared.result
    seconds = time.perf_counter() - clock
    if not current_settings().quiet:
        words = f"{tally.ran} members ran, {tally.was_done} were done before, {tally.failed} failed, {seconds:.1f} s"
        click.echo(words, err=True)
    numbers = {"ran": tally.ran, "was_done": tally.was_done, "failed": tally.failed, "seconds": round(seconds, 3)}
    click.echo(json.dumps({"path": str(path), **numbers}) if as_json else str(path))


@contextmanager
def _member_bar(prepared: Sweep) -> Iterator[Watcher | None]:
    """A bar over the members: rate, remaining time, failures; on stderr, on a terminal only."""
    if current_settings().quiet or not sys.stderr.isatty():
        yield None
        return
    from tqdm import tqdm

    tally = prepared.tally
    with tqdm(total=len(prepared.to_run), unit="member", leave=False, file=sys.stderr) as bar:

        def watcher(_: object) -> None:
            bar.set_postfix(failed=tally.failed, refresh=False)
            bar.update()

        yield watcher
