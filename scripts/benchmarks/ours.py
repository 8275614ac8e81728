"""rodloop itself behind the interface of the peers, so that one driver times all of them alike.

Timed: the initial shape (the unloaded equilibrium included), the march and the observables at the stated times; not
imports. Of the peers nothing but set-up and integration is timed, so that is measured too, in a run of its own.
"""

import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from rodloop_cli.case import Case, ModePerturbation, Segment
from rodloop_cli.dataset.rows import Row
from rodloop_cli.dataset.variables import Attribute
from rodloop_cli.simulation import Run
from rodloop_cli.statics import unloaded
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
    notes = f"{sink.attributes['total_steps']} steps"
    return Outcome(wall, relative_to_start(sink.rows), notes, alone(case) if case.scheme == "radau" else None)


def alone(case: Case) -> float:
    """Seconds of set-up and steps: no rows, no events, and the unloaded equilibrium taken off."""
    begun = time.perf_counter()
    run = Run.of(case)
    if run.begun.rod.has_stiffness_contrast:
        equations, found = run.begun.state.equations, time.perf_counter()
        unloaded(equations.mesh, equations.rule)
        begun += 2 * (time.perf_counter() - found)
    for _ in run.marcher:
        pass
    return time.perf_counter() - begun


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
GRID = [{"scheme": "bdf2", "N": n, "dt": dt} for n in (100, 200, 300, 400) for dt in (4e-2, 2e-2, 1e-2, 5e-3)]
FINE_GRID = [{"scheme": "bdf2", "N": n, "dt": dt} for n in (100, 200, 300) for dt in (2e-3, 1e-3)]

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
