"""What the tolerance delivers: position error over tol, on reference and random cases.

The error is the largest distance between the stored positions of a run and of the same run at tol/1000, up to the
first crossing, after the rigid motion between the two shapes is taken out.

    python -m scripts.benchmarks.tolerance [--random N] [--consistent N] [--jumping N] [--tols 1e-3,1e-4,…]
"""

import argparse
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rodloop_cli.case import Case, ModePerturbation, RandomModes, RandomPerturbation
from rodloop_cli.dataset.rows import Row
from rodloop_cli.dataset.variables import Attribute
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.simulation import Run

TIGHTER = 1e-3
REFERENCES: dict[str, dict[str, Any]] = {
    "homogeneous p=3.8": {"p": 3.8, "t_end": 9.6, "perturbation": (ModePerturbation(mode=2, amplitude=5e-3),)},
    "stiffness 5 p=3.8": {"p": 3.8, "stiffness_ratio": 5.0, "t_end": 2.26},
    "density 5 p=3.8": {
        "p": 3.8,
        "density_ratio": 5.0,
        "t_end": 11.5,
        "perturbation": (ModePerturbation(mode=2, amplitude=5e-3),),
    },
    "stiffness 12.8 drag 2": {"p": 5.0, "stiffness_ratio": 12.8, "zeta_perp": 2.0, "t_end": 3.0},
    "homogeneous p=64": {
        "p": 64.0,
        "t_end": 0.28,
        "perturbation": (
            ModePerturbation(mode=5, amplitude=2e-5, phase=0.4),
            ModePerturbation(mode=6, amplitude=5e-5),
            ModePerturbation(mode=7, amplitude=2e-5, phase=1.0),
        ),
    },
}


class Positions:
    """Keeps time and positions of every row, and the attributes."""

    def __init__(self) -> None:
        self.times: list[float] = []
        self.shapes: list[Array] = []
        self.residuals: list[float] = []
        self.attributes: dict[str, Attribute] = {}

    def append(self, row: Row) -> None:
        """Take a row."""
        self.times.append(float(np.asarray(row["t"])))
        self.shapes.append(np.stack([np.asarray(row["x"]), np.asarray(row["y"])]))
        self.residuals.append(float(np.asarray(row["energy_residual"])))

    def flush_if_due(self) -> None:
        """Nothing waits."""

    def finish(self, attributes: Mapping[str, Attribute]) -> None:
        """Keep the outcome."""
        self.attributes = dict(attributes)


def consistent_cases(count: int, seed: int = 11) -> Iterator[tuple[str, dict[str, Any]]]:
    """Loops of all kinds whose moment does not jump at t = 0: contrast of stiffness, or a perturbation, not both."""
    for i in range(count):
        generator = np.random.default_rng(seed + i)
        p = float(generator.choice([-1, 1, 1, 1]) * np.exp(generator.uniform(np.log(2), np.log(100))))
        wave = RandomModes(amplitude=float(10 ** generator.uniform(-4, -2)), modes=(2, 8), seed=i)
        stiffness = float(np.exp(generator.uniform(-2.3, 2.3)))
        case = {
            "p": p,
            "density_ratio": float(np.exp(generator.uniform(-2.3, 2.3))),
            "k": float(generator.uniform(0.2, 0.8)),
            "zeta_perp": float(generator.choice([0.0, generator.uniform(0.1, 3)])),
            "t_end": 8.0 / (1 + abs(p)) ** 0.75,
        }
        more = {"perturbation": (RandomPerturbation(random=wave),)} if i % 2 else {"stiffness_ratio": stiffness}
        yield f"consistent {i}", case | more


def random_cases(count: int, seed: int = 20260614) -> Iterator[tuple[str, dict[str, Any]]]:
    """Loops with contrast of stiffness and a perturbation: loads of both signs, contrasts up to 10, drag in half."""
    generator = np.random.default_rng(seed)
    for i in range(count):
        p = float(generator.choice([-1, 1, 1, 1]) * np.exp(generator.uniform(np.log(2), np.log(100))))
        case = {
            "p": p,
            "stiffness_ratio": float(np.exp(generator.uniform(-2.3, 2.3))),
            "density_ratio": float(np.exp(generator.uniform(-2.3, 2.3))),
            "k": float(generator.uniform(0.2, 0.8)),
            "zeta_perp": float(generator.choice([0.0, generator.uniform(0.1, 3)])),
            "t_end": 8.0 / (1 + abs(p)) ** 0.75,
            "perturbation": (
                RandomPerturbation(
                    random=RandomModes(amplitude=float(10 ** generator.uniform(-4, -2)), modes=(2, 8), seed=i)
                ),
            ),
        }
        yield f"random {i}", case


def jumping_cases(count: int, seed: int = 1020) -> Iterator[tuple[str, dict[str, Any]]]:
    """Perturbed loops of stiffness ratio 2 to 20: their moment jumps at the junctions from the start."""
    for i in range(count):
        generator = np.random.default_rng(seed + i)
        ratio = float(np.exp(generator.uniform(np.log(2), np.log(20))))
        amplitude = float(10 ** generator.uniform(-3, np.log10(0.05)))
        p = float(np.exp(generator.uniform(np.log(4), np.log(50))))
        k = float(generator.uniform(0.3, 0.7))
        mode, phase = int(generator.integers(2, 6)), float(generator.uniform(0, 6.28))
        wave = ModePerturbation(mode=mode, amplitude=amplitude, phase=phase)
        case = {"p": p, "stiffness_ratio": ratio, "k": k, "t_end": 3.0 / (1 + p) ** 0.75, "perturbation": (wave,)}
        yield f"jumping {i}, ε = {amplitude:.0e}", case


def solve(case: dict[str, Any], tol: float) -> Positions:
    """One run."""
    positions = Positions()
    Run.of(Case(**case, tol=tol)).into(positions)
    return positions


def error(run: Positions, reference: Positions) -> float:
    """Largest distance in the frame of the loop; rows at equal times only (a crossing ends both runs, not quite
    together).
    """
    count = sum(a == b for a, b in zip(run.times, reference.times, strict=False))
    return max(distance(a, b) for a, b in zip(run.shapes[:count], reference.shapes[:count], strict=True))


def distance(shape: Array, other: Array) -> float:
    """Largest distance of (2, S) points after the best rigid motion (complex Procrustes)."""
    a, b = shape[0] + 1j * shape[1], other[0] + 1j * other[1]
    a, b = a - a.mean(), b - b.mean()
    turn = np.vdot(b, a)
    return float(np.abs(a - b * turn / abs(turn)).max())


def main() -> None:
    """Print a table of error/tol and of the energy residual relative to the largest energy change."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--random", type=int, default=0, help="this many loops with both, whose moment jumps")
    parser.add_argument("--consistent", type=int, default=10, help="this many loops without a jump of the moment")
    parser.add_argument("--jumping", type=int, default=0, help="this many loops with a jump of the moment")
    parser.add_argument("--tols", default="1e-3,1e-4,1e-5,1e-6")
    parser.add_argument("--tighter", type=float, default=TIGHTER, help="tolerance of the reference, over tol")
    parser.add_argument("--no-references", action="store_true", help="the random cases alone")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    known = [] if options.no_references else list(REFERENCES.items())
    rows = []
    drawn = [
        *consistent_cases(options.consistent),
        *random_cases(options.random),
        *jumping_cases(options.jumping),
    ]
    for name, case in [*known, *drawn]:
        for tol in map(float, options.tols.split(",")):
            run = solve(case, tol)
            ratio = error(run, solve(case, tol * options.tighter)) / tol
            totals = {key: value for key, value in run.attributes.items() if key.startswith("total")}
            rows.append({"case": name, "tol": tol, "ratio": ratio, **totals})
            words = f"{name:24s} tol {tol:.0e} error/tol {ratio:8.3f} residual {max(map(abs, run.residuals)):.1e}"
            print(f"{words} steps {totals['total_steps']} cells {totals['total_cells']}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1, default=float))


if __name__ == "__main__":
    main()
