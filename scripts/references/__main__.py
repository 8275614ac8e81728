"""python -m scripts.references --case S: write the reference observables of a case with their uncertainty.

Each reference is computed at two resolutions and the finer one is kept; the uncertainty stated is their largest
difference over the stated times, hence that of the coarser one.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from . import fourier_run, galerkin_run
from .observables import DATA, Row, largest_differences, read_reference, shape_error, write_reference
from .problem import PROBLEMS, Problem

#: Resolutions (coarse, fine); a few seconds for H and P64, many minutes for the loops with junctions.
RESOLUTIONS: dict[str, list[dict[str, Any]]] = {
    "H": [{"n": 49}, {"n": 65}],
    "P64": [{"n": 97}, {"n": 129}],
    "S": [{"degree": 10, "per_segment": 4}, {"degree": 12, "per_segment": 4}],
    "D": [{"degree": 6, "per_segment": 4}, {"degree": 8, "per_segment": 4}],
    "R": [{"degree": 6, "per_segment": 4}, {"degree": 8, "per_segment": 4}],
}


def compute(problem: Problem, resolution: dict[str, Any]) -> list[Row]:
    if "n" in resolution:
        return fourier_run.solve(problem, **resolution)
    return galerkin_run.solve(problem, rtol=1e-9, atol=1e-9, **resolution)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m scripts.references", description=__doc__)
    parser.add_argument("--case", choices=PROBLEMS, action="append", help="default: all")
    parser.add_argument("-o", "--output", type=Path, default=DATA, help="folder of the JSON files")
    parser.add_argument("--compare", type=Path, help="folder with other solutions, <case name>.json")
    options = parser.parse_args()
    for case in options.case or PROBLEMS:
        problem = PROBLEMS[case]
        coarse, fine = (compute(problem, r) for r in RESOLUTIONS[case])
        difference = largest_differences(coarse, fine)
        method = "Fourier reduced form, DOP853" if "n" in RESOLUTIONS[case][0] else "Galerkin in theta, DOP853"
        write_reference(options.output / f"{problem.name}.json", problem,
                        {"name": method, "resolutions": RESOLUTIONS[case]}, fine, difference)  # fmt: skip
        print(f"{case}: coarse against fine {shape_error(coarse, fine):.1e}")
        if options.compare:
            _report(fine, read_reference(options.compare / f"{problem.name}.json"))


def _report(rows: list[Row], others: list[Row]) -> None:
    print(f"   against the other solution {shape_error(rows, others):.1e}")
    for quantity, value in largest_differences(rows, others).items():
        print(f"   {quantity:24s}{value:.1e}")


if __name__ == "__main__":
    main()
