"""A hundred periods without drag, the way back in time, and damped loops that come to rest."""

import collections
from dataclasses import dataclass, replace

import numpy as np

from rodloop_cli.case import Case
from rodloop_cli.march.loop import Marcher
from rodloop_cli.simulation import Run
from rodloop_cli.simulation.rest import distance
from rodloop_cli.statics import relax
from scripts.stress.cases import Keywords
from scripts.stress.trial import Rows, relative_residual

PERIOD = 9.5247
LOOP: Keywords = {"p": 3.8, "perturbation": [{"mode": 2, "amplitude": 5e-3}], "stop_at": []}


@dataclass(frozen=True)
class Drift:
    """Of a long undamped run: energy residual over the energy exchanged, first period and mean of all."""

    tol: float
    periods: int
    residual: float
    first_period: float
    mean_period: float
    seconds: float


def drift(tol: float, periods: int) -> Drift:
    """Run so many periods."""
    rows = Rows()
    run = Run.of(Case(t_end=PERIOD * (periods + 0.7), tol=tol, snapshots=4 * periods + 1, output_points=32, **LOOP))
    run.into(rows)
    times = np.array([time for time, _ in run.summary.extrema.minima])
    gaps = np.diff(times[np.concatenate([[True], np.diff(times) > PERIOD / 2])])
    found = (float(gaps[0]), float(gaps.mean())) if len(gaps) else (np.nan, np.nan)
    return Drift(tol, len(gaps), relative_residual(rows), *found, run.summary.seconds)


def way_back(tol: float, t_end: float) -> float:
    """Run, turn the velocity around, run as long again: largest distance from the start."""
    case = Case(t_end=t_end, tol=tol, N=32, snapshots=2, output_points=32, **LOOP)
    there, back = Run.of(case).marcher, Run.of(case).marcher
    assert isinstance(back, Marcher)
    begin = back.state
    end = collections.deque(there, maxlen=1)[0].end
    back.state = replace(end, time=0.0, velocity=-end.velocity, rates=-end.rates)
    home = collections.deque(back, maxlen=1)[0].end
    return distance(home, begin.unknowns)


def rest(keywords: Keywords) -> tuple[str, float]:
    """A damped run with `settled`: its outcome, and the distance from the equilibrium nearest to where it ended."""
    run = Run.of(Case(stop_at=("settled",), snapshots=2, output_points=32, tol=1e-6, **keywords))
    run.into(Rows())
    state = run.marcher.state
    return run.summary.outcome, distance(state, relax(state.equations, state.unknowns))
