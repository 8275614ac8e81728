"""A short made-up run, for files and memory alike."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rodloop_cli.dataset import RunWriter, run_attributes
from rodloop_cli.dataset.rows import Row
from rodloop_cli.dataset.variables import PROFILES, SCALARS

POINTS = 40
S = np.linspace(0.0, 2.0 * np.pi, POINTS, endpoint=False)
SEGMENT = np.repeat([1, 2], POINTS // 2)


@pytest.fixture
def fixed() -> dict[str, object]:
    """What a sink is made with, apart from the path."""
    attributes = run_attributes(
        title="Föppl's loop", case_text="p: 3.8\nt_end: 2.5\n", case_sha256="0" * 64, command="rodloop run a.yaml"
    )
    return {"s": S, "segment": SEGMENT, "attributes": attributes}


@pytest.fixture
def row() -> Callable[[float], Row]:
    """A row of the table at a time, every value another."""

    def make(t: float) -> dict[str, object]:
        profiles = {v.name: np.sin(S + t) + i for i, v in enumerate(PROFILES)}
        scalars = {v.name: t + i for i, v in enumerate(SCALARS)}
        return {"t": t, **profiles, **scalars, "lobes": 3, "newton_iterations": 4, "crossing": t > 0.5}

    return make


@pytest.fixture
def written(tmp_path: Path, fixed: dict, row: Callable[[float], Row]) -> Path:
    """A finished result of 120 rows, more than two blocks."""
    path = tmp_path / "out.nc"
    with RunWriter(path, **fixed) as writer:
        for t in np.arange(120) / 100:
            writer.append(row(float(t)))
        writer.finish({"outcome": "reached t_end", "total_steps": 12, "total_wall_time": 0.5})
    return path
