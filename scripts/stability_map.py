"""Which loops of two segments never lose stability: the map over stiffness ratio and k of docs/stability-analysis.md.

    python scripts/stability_map.py [--ratios 40] [--fractions 20] [-j 2] [-o docs/figures]

Each branch of equilibria is followed from p = 0 until it loses stability or the loop touches itself; writes
stability-map.nc and stability-map.png.
"""

import argparse
import time
from itertools import product
from pathlib import Path

import numpy as np

from rodloop_cli.critical.curves import Grid, over_grid
from rodloop_cli.critical.loads import Search
from rodloop_cli.dataset.stability_columns import critical_columns
from rodloop_cli.dataset.stability_files import CRITICAL, write_table
from rodloop_cli.plot.file import plot_file

FAR = 200.0
"""p R³/B1 at which a search gives up: every loop has lost stability or touches itself before."""


def main() -> None:
    """Compute and draw the map."""
    options = _options()
    ratios = np.geomspace(0.15, 6.0, options.ratios)
    fractions = np.linspace(0.05, 0.95, options.fractions)
    grid = Grid((0.9999,), tuple(ratios.tolist()), tuple(fractions.tolist()))
    clock = time.perf_counter()
    outcomes = list(over_grid(grid, Search(p_max=FAR, until_contact=True), options.jobs))
    print(f"{len(grid)} loops in {time.perf_counter() - clock:.0f} s on {options.jobs} processes")
    for (ratio, k), outcome in zip(product(ratios, fractions), outcomes, strict=True):
        if isinstance(outcome, str):
            print(f"ratio {ratio:.4g}, k {k:.4g}: {outcome}")
    path = Path(options.output) / "stability-map.nc"
    title = "Loss of stability of loops of two stiffnesses"
    write_table(path, CRITICAL, critical_columns(grid, outcomes), {"title": title}, force=True)
    print(plot_file(path, "maps", path.with_suffix(".png")))


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ratios", type=int, default=40)
    parser.add_argument("--fractions", type=int, default=20)
    parser.add_argument("-j", "--jobs", type=int, default=2)
    parser.add_argument("-o", "--output", default="docs/figures")
    return parser.parse_args()


if __name__ == "__main__":
    main()
