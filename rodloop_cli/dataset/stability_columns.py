"""From modes and critical loads to the columns of their files."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from rodloop_cli.critical.curves import Grid, Outcome
from rodloop_cli.critical.loads import CriticalLoads
from rodloop_cli.dataset.stability_files import KINDS, Columns
from rodloop_cli.stability.modes import ModesAt

Array = npt.NDArray[np.float64]


def mode_columns(found: Sequence[ModesAt]) -> Columns:
    """The variables of a modes file; all loads have the same number of modes."""
    modes = [at.modes for at in found]
    rates = np.array([[mode.rate for mode in row] for row in modes])
    displacement = np.array([[mode.displacement for mode in row] for row in modes])
    turning = np.array([[mode.turning for mode in row] for row in modes])
    curvature = np.array([[mode.curvature for mode in row] for row in modes])
    shapes = {
        "displacement_x": displacement[:, :, 0],
        "displacement_y": displacement[:, :, 1],
        "turning": turning,
        "curvature_change": curvature,
    }
    return {
        "p": [at.p for at in found],
        "mode": np.arange(1, rates.shape[1] + 1),
        "s": found[0].outline.s,
        "segment": found[0].outline.segment,
        "x": [at.outline.position[0] for at in found],
        "y": [at.outline.position[1] for at in found],
        "curvature": [at.outline.curvature for at in found],
        "growth_rate": rates.real,
        "frequency": rates.imag,
        "lobes": [[mode.lobes for mode in row] for row in modes],
        **{name: np.real(values) for name, values in shapes.items()},
        **{f"{name}_imaginary": np.imag(values) for name, values in shapes.items()},
    }


def critical_columns(grid: Grid, outcomes: Sequence[Outcome]) -> Columns:
    """The variables of a critical file; outcomes in the order of the grid, NaN where there is none."""
    by_area = {name: _numbers(outcomes, name).reshape(grid.shape) for name in ("p_alpha", "p_limit")}
    of_rod = ("compressibility", "p_stability", "p_soft", "p_contact", "p_searched")
    # What does not depend on α was computed for every α alike.
    by_rod = {name: _numbers(outcomes, name).reshape(grid.shape)[0] for name in of_rod}
    kinds = np.array([_kind(outcome) for outcome in outcomes], dtype=np.int8).reshape(grid.shape)[0]
    axes = {"alpha": grid.alpha, "stiffness_ratio": grid.stiffness_ratio, "k": grid.k}
    return {**axes, **by_area, **by_rod, "stability_kind": kinds}


def _numbers(outcomes: Sequence[Outcome], name: str) -> Array:
    values = [getattr(outcome, name) if isinstance(outcome, CriticalLoads) else None for outcome in outcomes]
    return np.array([np.nan if value is None else value for value in values], dtype=np.float64)


def _kind(outcome: Outcome) -> int:
    if isinstance(outcome, str):
        return KINDS.index("not_computed")
    return KINDS.index(outcome.stability_kind or "none")
