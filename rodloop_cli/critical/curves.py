"""Critical loads over a grid of two-segment rods, several at a time in processes of their own."""

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from itertools import product
from multiprocessing import get_context

from threadpoolctl import threadpool_limits

from rodloop_cli.critical.loads import CriticalLoads, Search, critical_loads
from rodloop_cli.errors import ConvergenceError
from rodloop_cli.physics.rod import Rod, Segment


@dataclass(frozen=True)
class Grid:
    """The values of α, of the stiffness ratio B2/B1 and of the fraction k of segment 1."""

    alpha: tuple[float, ...]
    stiffness_ratio: tuple[float, ...]
    k: tuple[float, ...]

    @property
    def shape(self) -> tuple[int, int, int]:
        return len(self.alpha), len(self.stiffness_ratio), len(self.k)

    @property
    def points(self) -> Iterator[tuple[float, float, float]]:
        """α, stiffness ratio and k of every rod, k fastest."""
        return product(self.alpha, self.stiffness_ratio, self.k)

    def __len__(self) -> int:
        return len(self.alpha) * len(self.stiffness_ratio) * len(self.k)


Outcome = CriticalLoads | str
"""The loads of one rod, or why there are none."""


def two_segments(stiffness_ratio: float, k: float) -> Rod:
    """Segment 1 of fraction k and stiffness 1, segment 2 the rest; one uniform rod at ratio 1."""
    if stiffness_ratio == 1:
        return Rod()
    return Rod((Segment(k), Segment(1 - k, stiffness_ratio)))


def over_grid(grid: Grid, search: Search, jobs: int = 2) -> Iterator[Outcome]:
    """The outcome of every rod, in the order of the grid, k fastest."""
    tasks = [
        (two_segments(ratio, k), replace(search, alpha=alpha))
        for alpha, ratio, k in grid.points
    ]
    if jobs == 1:
        yield from map(_loads, tasks)
        return
    # Not forked: the libraries may have threads of their own.
    with ProcessPoolExecutor(jobs, get_context("spawn"), _one_thread) as pool:
        yield from pool.map(_loads, tasks, chunksize=max(1, min(8, len(tasks) // (4 * jobs))))


def _loads(task: tuple[Rod, Search]) -> Outcome:
    try:
        return critical_loads(*task)
    except ConvergenceError as error:
        return str(error)


def _one_thread() -> None:
    threadpool_limits(1)
