"""What is compared between methods: quantities that need neither an origin nor an orientation."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .problem import Problem

Array = NDArray[np.float64]
Row = dict[str, float]

DATA = Path(__file__).parent / "data"
QUANTITIES = (
    "area",
    "bending_energy_change",
    "surface_energy_change",
    "kinetic_energy",
    "distance_junctions",
    "distance_midpoints",
    "moment_at_s0",
    "dissipated_energy",
)


def make_row(t: float, p: float, area: float, bending: float, kinetic: float, quarters: Array, moment: float,
             dissipated: float = 0.0) -> Row:  # fmt: skip
    """One stated time. ``quarters`` [4, 2]: positions at s = 0, pi/2, pi, 3 pi/2; energies are absolute here."""
    return {
        "t": float(t),
        "area": float(area),
        "bending_energy_change": float(bending),
        "surface_energy_change": float(p * area),
        "kinetic_energy": float(kinetic),
        "distance_junctions": float(np.hypot(*(quarters[0] - quarters[2]))),
        "distance_midpoints": float(np.hypot(*(quarters[1] - quarters[3]))),
        "moment_at_s0": float(moment),
        "dissipated_energy": float(dissipated),
    }


def relative_to_start(rows: list[Row]) -> list[Row]:
    """Bending and surface energy as changes since the first row."""
    changed = ("bending_energy_change", "surface_energy_change")
    return [row | {key: row[key] - rows[0][key] for key in changed} for row in rows]


def largest_differences(rows: list[Row], others: list[Row]) -> Row:
    """Largest absolute difference of each quantity over the times that both lists state."""
    by_time = {round(row["t"], 9): row for row in others}
    pairs = [(row, by_time[round(row["t"], 9)]) for row in rows if round(row["t"], 9) in by_time]
    return {q: max(abs(a[q] - b[q]) for a, b in pairs) for q in QUANTITIES if q in pairs[0][1]}


def shape_error(rows: list[Row], others: list[Row]) -> float:
    """The error measure of the benchmarks: max over time of area error / pi and distance error / 10."""
    d = largest_differences(rows, others)
    return max(d["area"] / np.pi, d["distance_junctions"] / 10, d["distance_midpoints"] / 10)


def energy_defect(rows: list[Row]) -> float:
    """Largest |Eb + Et + Ek + Ed - its start|: small only if the whole run is."""
    parts = ("bending_energy_change", "surface_energy_change", "kinetic_energy", "dissipated_energy")
    return max(abs(sum(row[q] for q in parts)) for row in rows)


def write_reference(path: Path, problem: Problem, method: dict[str, Any], rows: list[Row], uncertainty: Row) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    content = {
        "case": problem.describe(),
        "method": method,
        "uncertainty": {k: float(f"{v:.1e}") for k, v in uncertainty.items()},
        "energy_defect": float(f"{energy_defect(rows):.1e}"),
        "observables": rows,
    }
    path.write_text(json.dumps(content, indent=1) + "\n")


def read_reference(path: Path) -> list[Row]:
    rows: list[Row] = json.loads(path.read_text())["observables"]
    return rows
