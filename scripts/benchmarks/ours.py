"""rodloop itself behind the interface of the peers, so that one driver times all of them alike.

Timed: the initial shape (the unloaded equilibrium included), the march and the observables at the stated times; not
imports.
"""

import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from rodloop_cli.case import Case, ModePerturbation, Segment
from rodloop_cli.dataset.rows import Row
from rodloop_cli.dataset.variables import Attribute
from rodloop_cli.simulation import Run
from scripts.benchmarks.peers.interface import Outcome, Peer
from scripts.references.observables import make_row, relative_to_start
from scripts.references.problem import Problem

QUARTERS = 8
"""Output points: every second one is a quarter of the loop."""


class Observables:
    """A sink that keeps what the references state."""

    def __init__(self, p: float) -> None:
        self._p = p
        self.rows: list[dict[str, float]] = []
        self.attributes: dict[str, Attribute] = {}

    def append(self, row: Row) -> None:
        """Take a stored time."""
        quarters = np.stack([np.asarray(row["x"]), np.asarray(row["y"])], axis=1)[:: QUARTERS // 4]
        numbers = (float(np.asarray(row[name])) for name in ("t", "area", "bending_energy", "kinetic_energy"))
        t, area, bending, kinetic = numbers
        moment = float(np.asarray(row["moment"])[0])
        self.rows.append(make_row(t, self._p, area, bending, kinetic, quarters, moment))

    def flush_if_due(self) -> None:
        """Nothing waits."""

    def finish(self, attributes: Mapping[str, Attribute]) -> None:
        """Keep the totals."""
        self.attributes = dict(attributes)


def solve(problem: Problem, **settings: Any) -> Outcome:
    """One run of rodloop on a benchmark problem."""
    case = case_of(problem, **settings)
    sink = Observables(problem.p)
    begun = time.perf_counter()
    Run.of(case).into(sink)
    wall = time.perf_counter() - begun
    return Outcome(wall, relative_to_start(sink.rows), f"{sink.attributes['total_steps']} steps")


def case_of(problem: Problem, **settings: Any) -> Case:
    """The case file's content for a benchmark problem."""
    return Case(
        p=problem.p,
        segments=tuple(Segment(**vars(s)) for s in problem.segments),
        zeta_perp=problem.zeta_perp,
        gamma=problem.gamma,
        perturbation=tuple(ModePerturbation(**vars(m)) for m in problem.perturbation),
        t_end=problem.t_end,
        snapshot_times=problem.times,
        output_points=QUARTERS,
        stop_at=(),
        **settings,
    )


TOLERANCES = (*(a * 10.0**-k for k in range(2, 7) for a in (10, 5, 2)), 1e-6, 1e-7, 1e-8, 1e-9)
GRID = [{"scheme": "bdf2", "N": n, "dt": dt} for n in (100, 200, 300) for dt in (2e-2, 1e-2, 5e-3, 2e-3)]
FINE_GRID = [{"scheme": "bdf2", "N": n, "dt": dt} for n in (100, 200, 300) for dt in (2e-3, 1e-3, 5e-4)]

RADAU = Peer(
    "rodloop radau",
    solve,
    {case: [{"tol": tol} for tol in TOLERANCES] for case in ("H", "P64")}
    | {case: [{"tol": tol} for tol in TOLERANCES[:-2]] for case in ("S", "D")},
    "tol",
)
PAPER = Peer(
    "paper's scheme (rodloop bdf2)",
    solve,
    {"H": GRID, "S": GRID, "D": GRID, "P64": FINE_GRID},
    "second-order differences in space and time",
)
