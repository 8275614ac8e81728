"""Two parameters at a time over their whole range: outcome, energy residual, error and retries."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np

from scripts.stress.cases import STORED, Keywords, motion_time
from scripts.stress.random_cases import FINISHED
from scripts.stress.trial import Trial, attempt, compare

mpl.use("Agg")
from matplotlib import pyplot as plt

BASE: Keywords = {"p": 3.8, "perturbation": [{"mode": 2, "amplitude": 5e-3}], "stop_at": [], **STORED}
LOADS = (-1e4, -1e3, -100.0, -10.0, -1.0, 1.0, 10.0, 100.0, 1e3, 1e4)


@dataclass(frozen=True)
class Axis:
    """A parameter and its values."""

    name: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class Map:
    """What is varied, over which base."""

    title: str
    x: Axis
    y: Axis
    base: Keywords


def _powers(low: int, high: int, per_decade: float = 1.0) -> tuple[float, ...]:
    count = int((high - low) * per_decade) + 1
    return tuple(float(value) for value in np.logspace(low, high, count))


LOAD = Axis("p", LOADS)
FIXED: Keywords = BASE | {"scheme": "bdf2", "N": 100, "steps": 100}
MAPS = {
    "stiffness": Map("radau, tol = 1e-4", Axis("stiffness_ratio", _powers(-3, 3)), LOAD, BASE),
    "density": Map("radau, tol = 1e-4", Axis("density_ratio", _powers(-3, 3)), LOAD, BASE),
    "fraction": Map(
        "radau, stiffness ratio 5",
        Axis("k", (0.01, 0.03, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99)),
        LOAD,
        BASE | {"stiffness_ratio": 5.0},
    ),
    "drag": Map("radau, tol = 1e-4", Axis("zeta_perp", (0.0, *_powers(-1, 4))), LOAD, BASE),
    "gamma": Map(
        "radau, drag 10",
        Axis("gamma", (0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0)),
        LOAD,
        BASE | {"zeta_perp": 10.0},
    ),
    "amplitude": Map("radau, tol = 1e-4", Axis("amplitude", (*_powers(-8, -1), 0.2)), LOAD, BASE),
    "tolerance": Map("radau", Axis("tol", _powers(-7, -2)), LOAD, BASE),
    "steps": Map("bdf2, ten steps", Axis("dt", _powers(-6, 0)), Axis("N", (8, 30, 100, 300, 1000, 3000, 10000)), FIXED),
    "fixed": Map("bdf2, N = 100, 100 steps", Axis("stiffness_ratio", _powers(-3, 3)), LOAD, FIXED),
}


def keywords_at(chosen: Map, x: float, y: float) -> Keywords:
    """The case of one point."""
    case: dict[str, Any] = chosen.base | {chosen.x.name: x, chosen.y.name: y}
    if "amplitude" in case:
        case["perturbation"] = [{"mode": 2, "amplitude": case.pop("amplitude")}]
    steps = case.pop("steps", None)
    if steps is None:
        return case | {"t_end": 3 * motion_time(case)}
    if "dt" in case:
        return case | {"N": int(case["N"]), "t_end": 10 * case["dt"]}
    t_end = 3 * motion_time(case)
    return case | {"t_end": t_end, "dt": t_end / steps}


def run_map(chosen: Map, seconds: float) -> list[list[Trial]]:
    """Rows of trials, one for each value of y."""
    return [[_point(keywords_at(chosen, x, y), seconds) for x in chosen.x.values] for y in chosen.y.values]


def _point(keywords: Keywords, seconds: float) -> Trial:
    trial, rows = attempt({"tol": 1e-4} | keywords if "scheme" not in keywords else keywords, seconds)
    if trial.kind in FINISHED and "tol" in trial.case:
        compare(trial, trial.case, rows, seconds)
    return trial


def draw_map(chosen: Map, trials: list[list[Trial]], path: Path) -> None:
    """Energy residual, error over tolerance if there is one, retries a step; a letter where the run did not end."""
    panels: dict[str, Callable[[Trial], float]] = {
        "log10 energy residual / exchanged": lambda t: float(np.log10(max(t.residual, 1e-12))),
        "log10 error / tol": lambda t: float(np.log10(max(t.error, 1e-4))),
        "failed or rejected steps / steps": lambda t: t.retries / max(1, t.work.get("steps", 0)),
    }
    if "scheme" in chosen.base:  # fixed steps keep no tolerance
        del panels["log10 error / tol"]
    figure, axes = plt.subplots(1, len(panels), figsize=(13 / 3 * len(panels), 4.2), layout="constrained")
    for ax, (label, value) in zip(axes, panels.items(), strict=True):
        image = ax.imshow([[value(t) for t in row] for row in trials], origin="lower", aspect="auto")
        figure.colorbar(image, ax=ax)
        ax.set_title(label, fontsize=9)
        ax.set_xticks(range(len(chosen.x.values)), [f"{v:g}" for v in chosen.x.values], rotation=60, fontsize=7)
        ax.set_yticks(range(len(chosen.y.values)), [f"{v:g}" for v in chosen.y.values], fontsize=7)
        ax.set_xlabel(chosen.x.name)
        ax.set_ylabel(chosen.y.name)
        for j, row in enumerate(trials):
            for i, trial in enumerate(row):
                if trial.kind != "end":
                    ax.text(i, j, trial.kind[0], ha="center", va="center", color="red")
    figure.suptitle(f"{chosen.title}   (r: no convergence, s: slow, b: bug, n: NaN)", fontsize=10)
    figure.savefig(path, dpi=110)
    plt.close(figure)
