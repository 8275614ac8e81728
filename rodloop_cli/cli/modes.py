"""``rodloop modes``: growth rates and shapes of the small motions about the base state of a case."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rodloop_cli.cli.arguments import case_file, overrides
from rodloop_cli.cli.settings import current_settings
from rodloop_cli.cli.values import numbers

if TYPE_CHECKING:
    from rodloop_cli.case import Case
    from rodloop_cli.stability.modes import ModesAt


@click.command()
@case_file
@overrides
@click.option("-n", "--count", default=24, show_default=True, type=click.IntRange(1, 200), help="How many modes.")
@click.option("--cells", type=click.IntRange(4, 200), help="Cells around the loop (default: chosen).")
@click.option(
    "--p",
    "loads",
    metavar="A:B:N",
    callback=numbers,
    help="Pressures instead of the case's: N from A to B, or a list A,B,C.",
)
@click.option("-o", "--output", metavar="OUT.nc", help="Write rates and mode shapes to this file.")
@click.option("-f", "--force", is_flag=True, help="Replace the file if it exists.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def modes(
    case_path: str,
    overrides: tuple[str, ...],
    count: int,
    cells: int | None,
    loads: tuple[float, ...] | None,
    output: str | None,
    force: bool,
    as_json: bool,
) -> None:
    """Growth rates and frequencies of the small motions about the base state of CASE.

    The base state is the circle of a loop of uniform stiffness, and otherwise the equilibrium that the unloaded loop is
    led to as the pressure grows to p. A motion goes as exp(lambda t), lambda = growth rate + i frequency; of a pair
    lambda, conj(lambda) the one with positive frequency is listed. The fastest growing motions come first, then the
    slowest oscillations; rigid motions are left out.
    """
    from threadpoolctl import threadpool_limits

    from rodloop_cli.case import load_case
    from rodloop_cli.simulation.start import load_of, rod_of
    from rodloop_cli.stability.modes import ModeSearch, modes_along

    case = load_case(case_path, overrides)
    load = load_of(case)
    with threadpool_limits(1):  # the matrices are small
        found = list(modes_along(rod_of(case), load, loads or (load.p,), ModeSearch(count, cells)))
    path = _written(case, found, output, force=force)
    if as_json:
        click.echo(json.dumps(as_object(found, path)))
        return
    for at in found:
        click.echo("\n".join(told(at)))
    if path:
        click.echo(str(path))


def as_object(found: list[ModesAt], path: Path | None) -> dict[str, object]:
    """For other programs: a list entry a load where several were asked for."""
    objects = [
        {
            "p": at.p,
            "eigenvalues": [[mode.rate.real, mode.rate.imag] for mode in at.modes],
            "lobes": at.lobes,
            "lobes_of_modes": [mode.lobes for mode in at.modes],
        }
        for at in found
    ]
    whole: dict[str, object] = dict(objects[0]) if len(objects) == 1 else {"loads": objects}
    return whole | ({"path": str(path)} if path else {})


def told(at: ModesAt) -> list[str]:
    """A table, and in one sentence what it says; the table alone where little is wanted."""
    lines = [" mode   growth rate     frequency   lobes"]
    lines += [
        f"{i:5d} {mode.rate.real:13.6f} {mode.rate.imag:13.6f} {mode.lobes:7d}" for i, mode in enumerate(at.modes, 1)
    ]
    first = at.modes[0]
    if first.rate.real > 0:
        words = f"the fastest growing mode has {first.lobes} lobes and grows e-fold in t = {1 / first.rate.real:.4g}"
    else:
        words = "no motion grows: the base state is stable"
    return lines if current_settings().quiet else [f"p = {at.p:g}: {words}", *lines]


def _written(case: Case, found: list[ModesAt], output: str | None, *, force: bool) -> Path | None:
    if output is None:
        return None
    from rodloop_cli.dataset.stability_columns import mode_columns
    from rodloop_cli.dataset.stability_files import MODES, write_table

    title = f"Modes: {case.title}" if case.title.strip() else "Modes"
    attributes = {"title": title, "case": case.to_yaml(), "case_sha256": case.sha256}
    return write_table(Path(output), MODES, mode_columns(found), attributes, force=force)
