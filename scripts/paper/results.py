"""Results by the names of their case files in ``configs/paper``; computed once for each content.

A result is kept under a key of the resolved case and of the program that computes it, so an
unchanged case is never run again.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from multiprocessing import get_context
from pathlib import Path

import xarray as xr

import rodloop_cli
from rodloop_cli import Case, load_case, open_run, simulate

ROOT = Path(__file__).parents[2]
CONFIGS = ROOT / "configs" / "paper"
OUT = ROOT / "out" / "paper"
STATICS = ("fig08a", "fig08b")
"""Grids of ``rodloop critical``, no runs."""

JOBS = 2
ONE_THREAD = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
"""The matrices are small; more threads only get in each other's way."""
LEAST_LOAD = "0.01"
"""As far as the branch of equilibria is followed: Fig. 8 needs p(α) alone."""


@cache
def program() -> str:
    """Version and content of the program: results of another one are computed anew."""
    package = Path(rodloop_cli.__file__).parent
    computing = ("case", "critical", "march", "numerics", "physics", "simulation", "stability", "statics")
    sources = sorted(path for part in computing for path in (package / part).rglob("*.py"))
    digest = hashlib.sha256(rodloop_cli.__version__.encode())
    for source in sources:
        digest.update(source.read_bytes())
    return digest.hexdigest()


def case(name: str, *overrides: str) -> Case:
    """The case of a file in ``configs/paper``, some keys set."""
    return load_case(CONFIGS / f"{name}.yaml", overrides)


def result(name: str, *overrides: str) -> xr.Dataset:
    """The result of a case, from the cache if it is there."""
    return open_run(_computed(case(name, *overrides)))


def table(name: str) -> xr.Dataset:
    """Critical pressures over the grid of a file, by ``rodloop critical``."""
    source = CONFIGS / f"{name}.yaml"
    path = _path(source.read_text())
    if not path.exists():
        command = [sys.executable, "-m", "rodloop_cli", "critical", str(source), "--p-max", LEAST_LOAD, "-q"]
        subprocess.run([*command, "-o", str(path), "--force"], check=True, stdout=subprocess.DEVNULL, env=ONE_THREAD)
    return xr.open_dataset(path, decode_cf=False)


def prepare(names: Iterable[str]) -> None:
    """Compute what is missing of some results, two at a time, those that take longest first."""
    wanted = sorted(set(names), key=lambda name: (name not in STATICS, -_expected(name)))
    with workers() as pool:
        list(pool.map(_prepare, wanted))


def workers() -> ProcessPoolExecutor:
    """Processes of one thread each."""
    os.environ.update(ONE_THREAD)
    return ProcessPoolExecutor(JOBS, get_context("spawn"))


def _prepare(name: str) -> None:
    (table if name in STATICS else result)(name).close()


def _expected(name: str) -> float:
    """A rough measure of the work of a run."""
    if name in STATICS:
        return 0.0
    asked = case(name)
    return float(asked.t_end * (1 + abs(asked.p)) ** 0.75 / (asked.tol or 1e-4) ** 0.2)


def _computed(asked: Case) -> Path:
    path = _path(asked.sha256)
    if not path.exists():
        part = path.with_suffix(".part")
        simulate(asked).to_netcdf(part)
        part.replace(path)
    return path


def _path(content: str) -> Path:
    (OUT / "results").mkdir(parents=True, exist_ok=True)
    return OUT / "results" / f"{hashlib.sha256(f'{program()} {content}'.encode()).hexdigest()[:20]}.nc"
