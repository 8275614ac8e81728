"""The manifest, the fit of growth rates, the names of members, the observer against the full result."""

import json
from math import sqrt

import numpy as np
import pytest

from rodloop_cli.case import Case
from rodloop_cli.simulation import Run, simulate
from rodloop_cli.sweep.columns import Status
from rodloop_cli.sweep.growth import fitted_rate
from rodloop_cli.sweep.manifest import Manifest
from rodloop_cli.sweep.naming import LONGEST_NAME, member_name
from rodloop_cli.sweep.observe import Nowhere, Observer


def observed(case):
    observer = Observer(Nowhere(), {"key": "k"}, has_drag=case.zeta_perp > 0)
    Run.of(case).into(observer, observer.reached)
    return observer.row


def test_a_torn_line_costs_itself_only(tmp_path):
    manifest = Manifest(tmp_path)
    manifest.append({"key": "a"})
    with (tmp_path / "manifest.jsonl").open("ab") as file:
        file.write(b'{"key": "b", "sta')
    assert [row["key"] for row in manifest.fresh()] == ["a"]
    Manifest(tmp_path).append({"key": "c"})
    assert [row["key"] for row in manifest.fresh()] == ["c"]
    assert [row["key"] for row in Manifest(tmp_path).fresh()] == ["a", "c"]


@pytest.mark.parametrize("line", ["[1]", "{}", '{"key": 3}', "", "nonsense", '{"key": "a", "status": true}'])
def test_lines_that_are_no_rows_are_skipped(tmp_path, line):
    (tmp_path / "manifest.jsonl").write_text(line + '\n{"key": "z"}\n')
    assert [row["key"] for row in Manifest(tmp_path).fresh()][-1] == "z"


@pytest.mark.parametrize(("c", "k", "f"), [(0.0, 4.0, 1e-4), (3.0, 4.0, 1e-4)])
def test_the_growth_rate_of_a_damped_mode_is_found(c, k, f):
    fast, slow = (-c / 2 + sign * sqrt(c * c / 4 + k) for sign in (1, -1))
    t = np.linspace(0, 2, 15)
    a, b = f / k * -slow / (fast - slow), f / k * fast / (fast - slow)
    sizes = a * np.exp(fast * t) + b * np.exp(slow * t) - f / k
    speeds = a * fast * np.exp(fast * t) + b * slow * np.exp(slow * t)
    assert fitted_rate(t, sizes, speeds, has_drag=c > 0) == pytest.approx(fast, rel=1e-4)


def test_a_swing_has_no_growth_rate():
    t = np.linspace(0, 2, 15)
    assert fitted_rate(t, 1 - np.cos(2 * t), 2 * np.sin(2 * t), has_drag=False) is None
    assert fitted_rate(t, 0 * t, 0 * t, has_drag=True) is None


def test_a_ring_buckles_at_the_rate_of_linear_theory():
    """sigma^2 = n^2 (n^2 - 1) (p - n^2 + 1) / (n^2 + 1) for mode n of a ring at rest under p."""
    case = Case.model_validate(
        {"p": 8.0, "t_end": 1.2, "snapshots": 40, "output_points": 32, "perturbation": [{"mode": 2, "amplitude": 1e-4}]}
    )
    assert observed(case)["growth_rate"] == pytest.approx(sqrt(4 * 3 * (8 - 3) / 5), rel=2e-3)


def test_the_row_is_what_the_full_result_says():
    case = Case.model_validate({"p": 20.0, "t_end": 2.0, "stiffness_ratio": 5.0, "snapshots": 30, "output_points": 64})
    row, full = observed(case), simulate(case)
    assert row["status"] == Status.crossed
    assert row["first_crossing_time"] == row["end_time"] == full.attrs["first_crossing_time"]
    assert row["peak_kinetic_energy"] == float(full["kinetic_energy"].max())
    assert row["minimum_area"] <= float(full["area"].min())
    assert (row["lobes_initial"], row["lobes_final"]) == (int(full["lobes"][0]), int(full["lobes"][-1]))
    moved = np.hypot(full["x"] - full["x"][0], full["y"] - full["y"][0])
    assert row["maximum_displacement"] == pytest.approx(float(moved.max()), rel=1e-12)
    assert row["steps"] == int(full.attrs["total_steps"])
    assert json.loads(json.dumps(row)) == row


def test_a_loop_that_comes_to_rest_has_a_settling_time():
    case = Case.model_validate(
        {"p": 1.0, "t_end": 60.0, "stiffness_ratio": 2.0, "zeta_perp": 5.0, "tol": 1e-2, "stop_at": ["settled"]}
        | {"snapshots": 10, "output_points": 16}
    )
    row = observed(case)
    assert row["status"] == Status.settled
    assert 0 < row["settling_time"] < 60


def test_long_names_stay_within_what_file_systems_allow():
    names = {member_name([(f"perturbation.{i}.amplitude", 1e-3 + j) for i in range(9)]) for j in range(2)}
    assert len(names) == 2
    assert all(len(name) <= LONGEST_NAME for name in names)
