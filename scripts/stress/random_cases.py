"""Random combinations of everything that can be asked: what becomes of them."""

import json
from collections import Counter
from pathlib import Path

import numpy as np

from scripts.stress.cases import random_case
from scripts.stress.trial import Trial, as_dict, attempt
from scripts.stress.trial import compare as compare_with_finer

FINISHED = {"end", "crossing", "settled"}
LARGE_RESIDUAL, LARGE_ERROR, LOOSE = 0.05, 10.0, 1e-3


def run_random(first: int, count: int, seconds: float, folder: Path, compare_every: int = 5) -> list[Trial]:
    """Run so many cases; one line of JSON each goes to random.jsonl as it is done."""
    folder.mkdir(parents=True, exist_ok=True)
    trials = []
    with (folder / "random.jsonl").open("a") as log:
        for seed in range(first, first + count):
            trial = one(seed, seconds, compare=seed % compare_every == 0)
            trials.append(trial)
            log.write(json.dumps({"seed": seed} | as_dict(trial)) + "\n")
            log.flush()
    return trials


def one(seed: int, seconds: float, *, compare: bool) -> Trial:
    """The case of this number."""
    keywords = random_case(seed)
    trial, rows = attempt(keywords, seconds)
    if compare and trial.kind in FINISHED and "tol" in keywords:
        compare_with_finer(trial, keywords, rows, 2 * seconds)
    return trial


def suspicious(trial: Trial) -> bool:
    """Worth a look: a bug for certain, or a number that the tolerance does not explain."""
    tight = trial.case.get("tol", 1.0) < LOOSE
    wrong = trial.error > LARGE_ERROR or (tight and trial.residual > LARGE_RESIDUAL)
    return trial.kind in {"bug", "nan", "slow"} or wrong


def told(trials: list[Trial]) -> list[str]:
    """The counts, and every suspicious case."""
    kinds = Counter(f"{trial.case.get('scheme', 'radau')} {trial.kind}" for trial in trials)
    lines = [f"{kind}: {count}" for kind, count in sorted(kinds.items())]
    errors = np.array([trial.error for trial in trials if np.isfinite(trial.error)])
    if len(errors):
        relative = np.array([trial.relative_error for trial in trials if np.isfinite(trial.relative_error)])
        lines.append(f"error/(tol x departure): median {np.median(relative):.2g}, largest {relative.max():.2g}")
        lines.append(f"error/tol: median {np.median(errors):.2g}, largest {errors.max():.2g} of {len(errors)}")
    return lines + [
        f"{t.kind} res {t.residual:.1e} err {t.error:.2g} {t.seconds:.1f} s cells {t.cells} {t.work} {t.case} "
        f"{t.outcome.splitlines()[-1] if t.outcome else ''}"
        for t in trials
        if suspicious(t)
    ]
