"""Error against wall time, rodloop and its peers in one run on one machine.

    python -m scripts.benchmarks.bench [--quick] [--json results.json]

Every setting is run once a round, one solver after the other, and the median over the rounds is kept: when the speed
of the machine drifts, it drifts for all. Settings are fixed beforehand, in `ours` and in the modules of `peers`.
Single-threaded.
"""

import argparse
import json
import platform
import statistics
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from rodloop_cli.numerics.allocator import keep_freed_memory
from scripts.benchmarks.ours import PAPER, RADAU
from scripts.benchmarks.peers.__main__ import FAILURES, PEERS
from scripts.benchmarks.peers.interface import Peer
from scripts.references.observables import DATA, read_reference, shape_error
from scripts.references.problem import PROBLEMS

ROUNDS = 4
LONG = 3.0
"""Seconds: what takes longer is run once."""

QUICK_PEERS = ("fourier_scipy", "ida")
Row = dict[str, Any]


def main() -> None:
    """Run the benchmark and write its rows."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer settings, two cases, under two minutes")
    parser.add_argument("--case", action="append", choices=("H", "S", "P64", "D"))
    parser.add_argument("--json", type=Path, default=Path("out/bench.json"))
    options = parser.parse_args()
    cases = options.case or (["H", "S"] if options.quick else ["H", "S", "P64", "D"])
    keep_freed_memory()
    rows: list[Row] = []
    with threadpool_limits(1):
        for case in cases:
            rows.extend(race(case, quick=options.quick))
    options.json.parent.mkdir(parents=True, exist_ok=True)
    options.json.write_text(json.dumps({"machine": machine(), "rows": rows}, indent=1) + "\n")
    print(options.json)


def race(case: str, *, quick: bool) -> list[Row]:
    """All solvers on one case."""
    entries = list(entrants(case, quick=quick))
    rows: list[Row] = [
        {"peer": peer.name, "case": case, "settings": settings, "walls": [], "alone": []} for peer, settings in entries
    ]
    for _ in range(ROUNDS):
        for (peer, settings), row in zip(entries, rows, strict=True):
            if not row["walls"] or (row["error"] is not None and row["walls"][0] < LONG):
                lap(peer, case, settings, row)
    for row in rows:
        # The first round compiles and fills caches.
        for name, laps in (("wall", row["walls"]), ("wall_alone", row.pop("alone"))):
            later = laps[1:] or laps
            row[name] = statistics.median(later) if later else None
        words = f"{row['wall']} s, error {row['error']}, {row['notes']}"
        print(f"{row['peer']:32s} {case:4s} {row['settings']} {words}", flush=True)
    return rows


def entrants(case: str, *, quick: bool) -> Iterator[tuple[Peer, Row]]:
    """Every solver with each of its settings; absent packages are passed over."""
    for peer in [RADAU, PAPER, *available(QUICK_PEERS if quick else tuple(PEERS))]:
        settings = peer.settings.get(case, [])
        if quick:
            settings = [s for s in settings if s.get("N") in {None, 100} and s.get("dt", 1.0) >= 1e-2][:7]
        for setting in settings:
            yield peer, setting


def available(modules: tuple[str, ...]) -> Iterator[Peer]:
    """The peers whose packages are installed."""
    for module in modules:
        try:
            loaded = import_module(f"scripts.benchmarks.peers.{module}")
        except ModuleNotFoundError as absent:
            print(f"{module}: absent ({absent})")
            continue
        yield from (getattr(loaded, name) for name in PEERS[module])


def lap(peer: Peer, case: str, settings: Row, row: Row) -> None:
    """One run of one setting."""
    problem = PROBLEMS[case]
    try:
        run = peer.solve(problem, **settings)
    except FAILURES as failure:
        row.update(error=None, notes=f"failed: {failure}"[:80], walls=[float("inf")])
        return
    error = shape_error(run.rows, read_reference(DATA / f"{problem.name}.json"))
    row.update(error=error, notes=run.notes)
    row["walls"].append(run.wall)
    if run.alone is not None:
        row["alone"].append(run.alone)


def machine() -> dict[str, str]:
    """What the numbers were measured on."""
    names = [line.split(":")[1].strip() for line in _cpuinfo() if line.startswith("model name")]
    return {"processor": names[0] if names else platform.processor(), "python": platform.python_version()}


def _cpuinfo() -> list[str]:
    path = Path("/proc/cpuinfo")
    return path.read_text().splitlines() if path.exists() else []


if __name__ == "__main__":
    main()
