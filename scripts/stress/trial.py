"""One case run to its end under a time limit, and what can be said of it."""

import signal
import time
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from types import FrameType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.case import Case
from rodloop_cli.errors import ConvergenceError
from rodloop_cli.simulation import Run
from scripts.benchmarks.tolerance import distance

Array = NDArray[np.float64]
Row = Mapping[str, Any]


ROUND_OFF = 1e-10
"""Of the energies: what their residual may be whatever the motion."""


UNPERTURBED = 1e-4
"""Departure that errors are measured against at least where nothing but round-off or the load moves the loop."""


class OutOfTimeError(Exception):
    """The case took longer than it was given."""


@dataclass
class Rows:
    """A sink that keeps what a file would have been given."""

    stored: list[Row] = field(default_factory=list)
    attributes: dict[str, Any] = field(default_factory=dict)

    def append(self, row: Row) -> None:
        self.stored.append(row)

    def flush_if_due(self) -> None:
        """Nothing waits."""

    def finish(self, attributes: Mapping[str, Any]) -> None:
        self.attributes.update(attributes)

    def column(self, name: str) -> Array:
        return np.array([row[name] for row in self.stored], dtype=float)

    @property
    def finite(self) -> bool:
        return all(np.isfinite(np.asarray(value)).all() for row in self.stored for value in row.values())

    @property
    def position(self) -> Array:
        """(rows, 2, S)."""
        return np.stack([self.column("x"), self.column("y")], axis=1)


@dataclass
class Trial:
    """What became of a case; ``kind``: end, crossing, settled, refused (no convergence), slow, nan, bug."""

    case: dict[str, Any]
    kind: str = "bug"
    outcome: str = ""
    seconds: float = 0.0
    residual: float = float("nan")
    """Largest energy residual over the largest exchange of energy."""
    error: float = float("nan")
    """Position error against a finer run, over tol."""
    relative_error: float = float("nan")
    """The same over tol and the departure, which the steps aim at."""
    work: dict[str, int] = field(default_factory=dict)
    cells: int = 0
    retries: int = 0


@contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Raises OutOfTimeError in the body after so many seconds."""

    def ring(_number: int, _frame: FrameType | None) -> None:
        raise OutOfTimeError

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def attempt(keywords: Mapping[str, Any], seconds: float = 20.0) -> tuple[Trial, Rows]:
    """Run a case; whatever happens is an answer."""
    trial, rows, began = Trial(dict(keywords)), Rows(), time.perf_counter()
    runs: list[Run] = []
    try:
        with limited(seconds), np.errstate(all="ignore"):
            runs.append(Run.of(Case(**keywords)))
            runs[0].into(rows)
        trial.outcome, trial.kind = runs[0].summary.outcome, _kind(runs[0].summary.outcome)
    except OutOfTimeError:
        trial.kind, trial.outcome = "slow", f"more than {seconds:g} s"
    except ConvergenceError as error:
        trial.kind, trial.outcome = "refused", str(error)
    except Exception:  # noqa: BLE001  any other exception is what is looked for
        trial.outcome = traceback.format_exc()
    trial.seconds = time.perf_counter() - began
    if runs:
        _measure(trial, runs[0], rows)
    return trial, rows


def _kind(outcome: str) -> str:
    return {"reached": "end", "stopped": "crossing", "settled": "settled"}[outcome.split(maxsplit=1)[0]]


def _measure(trial: Trial, run: Run, rows: Rows) -> None:
    trial.work, trial.cells = asdict(run.work), run.marcher.state.equations.mesh.cells
    trial.retries = run.work.rejected + run.work.newton_failures
    if rows.stored:
        trial.residual = relative_residual(rows)
        if not rows.finite:
            trial.kind = "nan"


def relative_residual(rows: Rows) -> float:
    """max |energy residual| over the energy that changed hands; 0 where it is the round-off of the energies."""
    changes = [np.ptp(rows.column(f"{name}_energy")) for name in ("bending", "surface", "kinetic")]
    exchanged = max(float(max(changes)), float(np.ptp(rows.column("dissipated_energy"))), 1e-30)
    size = sum(float(np.abs(rows.column(f"{name}_energy")).max()) for name in ("bending", "surface"))
    residual = float(np.abs(rows.column("energy_residual")).max())
    return 0.0 if residual < ROUND_OFF * size else residual / exchanged


def departure(rows: Rows, scale: float) -> Array:
    """(rows,): how far the loop has gone from where it began, at least ``scale`` and at most 1."""
    moved: Array = np.abs(rows.position - rows.position[0]).max(axis=(1, 2))
    return np.clip(moved, scale, 1.0)


def compare(trial: Trial, keywords: Mapping[str, Any], rows: Rows, seconds: float) -> None:
    """Fill in the errors against a run at a hundredth of the tolerance, if that ends.

    What tol promises is compared: positions in the frame of the loop, up to the first crossing.
    """
    finer, precise = attempt({**keywords, "tol": max(keywords["tol"] / 100, 1e-9)}, seconds)
    if finer.kind not in {"end", "crossing", "settled"}:
        return
    common = [i for i in range(min(len(rows.stored), len(precise.stored))) if _comparable(rows, precise, i)]
    scale = max((abs(w.get("amplitude", 0.0)) for w in _waves(keywords)), default=0.0)
    error = np.array([distance(rows.position[i], precise.position[i]) for i in common])
    allowed = keywords["tol"] * departure(precise, scale or UNPERTURBED)[common]
    trial.error = float(error.max() / keywords["tol"])
    trial.relative_error = float((error / allowed).max())


def _comparable(rows: Rows, others: Rows, i: int) -> bool:
    row, other = rows.stored[i], others.stored[i]
    return bool(row["t"] == other["t"]) and not (row["crossing"] or other["crossing"])


def _waves(keywords: Mapping[str, Any]) -> list[Mapping[str, float]]:
    return [wave.get("random", wave) for wave in keywords.get("perturbation", ())]


def as_dict(trial: Trial) -> dict[str, Any]:
    """For JSON."""
    return asdict(trial)
