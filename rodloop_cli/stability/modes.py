"""The small motions of a rod at one load, or at a range of loads: what ``rodloop modes`` reports."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.equations import Load
from rodloop_cli.physics.rod import Rod
from rodloop_cli.physics.sampling import Sampler
from rodloop_cli.stability.shapes import OUTPUT_POINTS, Mode, output_arclengths, sampled
from rodloop_cli.stability.spectrum import eigenmotions
from rodloop_cli.statics.branch import to_load
from rodloop_cli.statics.loaded import Loaded, at_zero_load, loaded_circle, upright

DEFAULT_COUNT = 24
"""Eleven pairs cover n = 2 … 12 of a uniform circle."""

LEAST_CELLS = 24
MODE_POINTS = 8
"""Gauss points in a cell: one to a wave then gives λ² to some 1e-8."""


class Outline(NamedTuple):
    """The base state at arclengths s (S,): position (2, S) and curvature (S,)."""

    s: Array
    position: Array
    curvature: Array
    segment: NDArray[np.int_]


@dataclass(frozen=True, eq=False)
class ModesAt:
    """The modes about the base state at load p, the fastest growing first."""

    p: float
    modes: list[Mode]
    outline: Outline

    @property
    def lobes(self) -> int:
        """Lobes of the mode that grows fastest (or decays slowest)."""
        return self.modes[0].lobes


@dataclass(frozen=True)
class ModeSearch:
    """How many modes, on how many cells (None: chosen), at how many points their shapes are given."""

    count: int = DEFAULT_COUNT
    cells: int | None = None
    points: int = OUTPUT_POINTS

    def cells_at(self, p: float) -> int:
        """A cell for each wave of the highest mode that is asked for, or that grows under the load."""
        return self.cells or max(LEAST_CELLS, self.count // 2 + 12, round(abs(p) ** 0.5) + 8)


def modes_at(rod: Rod, load: Load, search: ModeSearch) -> ModesAt:
    """The modes about the base state of a rod under a load.

    Raises ConvergenceError where there is no base state.
    """
    return next(modes_along(rod, load, (load.p,), search))


def modes_along(rod: Rod, load: Load, loads: tuple[float, ...], search: ModeSearch) -> Iterator[ModesAt]:
    """The modes at each of ``loads``; drag as in ``load``. Raises ConvergenceError where there is no base state."""
    cells = search.cells_at(max(loads, key=abs))
    base: Loaded | None = None
    for p in loads:
        base = base_state(rod, p, cells, base)
        yield _modes_about(base, replace(load, p=p), rod, search)


def base_state(rod: Rod, p: float, cells: int, known: Loaded | None = None) -> Loaded:
    """The circle if the stiffness is uniform, otherwise the equilibrium that the unloaded loop is led to as p grows.

    ``known``: another one of that branch. Raises ConvergenceError if the branch ends before p is reached.
    """
    if not rod.has_stiffness_contrast:
        return loaded_circle(rod, p, cells, MODE_POINTS)
    return upright(to_load(known or at_zero_load(rod, cells, MODE_POINTS), p))


def _modes_about(base: Loaded, load: Load, rod: Rod, search: ModeSearch) -> ModesAt:
    s = output_arclengths(search.points)
    modes = [sampled(base, motion, s) for motion in eigenmotions(base, search.count, load)]
    return ModesAt(base.p, modes, _outline(base, rod, s))


def _outline(base: Loaded, rod: Rod, s: Array) -> Outline:
    sampler = Sampler(base.equations.mesh, base.equations.rule, s)
    fields = base.fields
    curvature = sampler(fields.moment[0]) / sampler.stiffness
    return Outline(s, sampler(fields.position[:, 0]), curvature, rod.segment_at(s) + 1)
