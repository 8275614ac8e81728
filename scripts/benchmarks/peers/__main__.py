"""python -m scripts.benchmarks.peers --case H --json out.json: run every available peer over its settings.

Rows {peer, case, settings, wall, error, notes}: wall seconds of the median of the repeats, error against the references
(largest over the stated times of area error / pi and distance error / 10), null where the peer did not get through.
"""

from __future__ import annotations

import argparse
import importlib
import json
import statistics
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from scripts.references.observables import DATA, read_reference, shape_error
from scripts.references.problem import PROBLEMS

from .interface import Peer

#: Module and names of its peers.
PEERS = {
    "fourier_scipy": ("RADAU", "DOP853"),
    "galerkin_scipy": ("RADAU", "DOP853"),
    "ida": ("PEER",),
    "solve_dae_radau": ("PEER",),
    "polygon": ("PEER",),
    "paper_sparse": ("PLAIN", "KEPT"),
    "pyelastica_ring": ("PEER",),
}
CASES = ("H", "S", "P64", "D")
FAILURES = (RuntimeError, ArithmeticError, ValueError)  # what a solver that gives up raises

Row = dict[str, Any]


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m scripts.benchmarks.peers", description=__doc__)
    parser.add_argument("--case", choices=CASES, action="append", help="default: all")
    parser.add_argument("--peer", choices=PEERS, action="append", help="default: all")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--json", type=Path, help="write the rows here")
    options = parser.parse_args()
    warnings.filterwarnings("ignore", message="Custom sparse Jacobian")  # IDA: the analytic one is used
    rows = []
    for module in options.peer or PEERS:
        for row in run_module(module, options.case or list(CASES), options.repeats):
            rows.append(row)
            print(_line(row), flush=True)
            if options.json:
                options.json.write_text(json.dumps(rows, indent=1) + "\n")


def run_module(module: str, cases: list[str], repeats: int) -> Iterator[Row]:
    """Rows of all peers of a module; one row that says so if a package it needs is absent."""
    try:
        loaded = importlib.import_module(f".{module}", __package__)
    except ModuleNotFoundError as absent:
        yield {
            "peer": module,
            "case": None,
            "settings": None,
            "wall": None,
            "error": None,
            "notes": f"absent: {absent}",
        }
        return
    for peer in (getattr(loaded, name) for name in PEERS[module]):
        for case in cases:
            yield from run_peer(peer, case, repeats)


def run_peer(peer: Peer, case: str, repeats: int) -> Iterator[Row]:
    """One row for each setting; the first one is run once before, so that compilation and caches are out of the way."""
    for i, settings in enumerate(peer.settings.get(case, [])):
        row = {"peer": peer.name, "case": case, "settings": settings}
        yield row | measure(peer, case, settings, repeats, warm_up=i == 0) | {"limit": peer.limit}


def measure(peer: Peer, case: str, settings: dict[str, Any], repeats: int, *, warm_up: bool) -> Row:
    problem = PROBLEMS[case]
    try:
        runs = [peer.solve(problem, **settings) for _ in range(repeats + warm_up)][warm_up:]
    except FAILURES as failure:
        return {"wall": None, "error": None, "notes": f"failed: {failure}"}
    error = shape_error(runs[-1].rows, read_reference(DATA / f"{problem.name}.json"))
    return {"wall": statistics.median(run.wall for run in runs), "error": error, "notes": runs[-1].notes}


def _line(row: Row) -> str:
    if row["error"] is None:
        return f"{row['peer']} {row['case'] or ''} {row['settings'] or ''}: {row['notes']}"
    return (
        f"{row['peer']} {row['case']} {row['settings']}: {row['wall']:.4f} s, error {row['error']:.1e}, {row['notes']}"
    )


if __name__ == "__main__":
    main()
