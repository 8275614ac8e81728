"""``rodloop run``: what it says, on which stream, and what a result that is there already means."""

import json

import pytest

from rodloop_cli.cli import main
from rodloop_cli.errors import ConvergenceError
from rodloop_cli.march.loop import Marcher

CASE = "p: 3.8\nstiffness_ratio: 5\nt_end: 0.1\nsnapshots: 3\n"


@pytest.fixture
def run(tmp_path, capsys):
    """Runs the command on CASE; the exit code, stdout and stderr."""
    path = tmp_path / "case.yaml"
    path.write_text(CASE)

    def command(*arguments):
        code = main(["run", str(path), "-o", str(tmp_path / "out.nc"), *arguments])
        return code, *capsys.readouterr()

    return command


def test_the_path_is_printed_and_the_rest_said(run, tmp_path):
    code, shown, said = run()
    assert (code, shown) == (0, f"{tmp_path}/out.nc\n")
    assert said.splitlines()[0] == "reached t_end"
    assert "energy residual" in said


def test_numbers_for_programs(run):
    code, shown, _ = run("--json")
    numbers = json.loads(shown)
    assert code == 0
    assert {"path", "outcome", "steps", "jacobians", "factorizations", "largest_energy_residual"} <= set(numbers)
    assert numbers["warnings"] == []


def test_a_finished_result_is_not_computed_again(run):
    first = json.loads(run("--json")[1])
    code, shown, said = run("--resume", "--json")
    again = json.loads(shown)
    assert first.pop("wall_seconds") == pytest.approx(again.pop("wall_seconds"), abs=0.1)
    assert (code, again) == (0, first)
    assert said.endswith("out.nc is finished already\n")
    assert run()[0] == 2


def test_a_failed_result_is_not_a_finished_one(run, tmp_path, monkeypatch):
    def give_up(_):
        raise ConvergenceError("no convergence at t = 0: try something else")

    monkeypatch.setattr(Marcher, "_size", give_up)
    code, shown, said = run()
    assert (code, shown) == (3, "")
    assert said.splitlines()[0].startswith("no convergence at t = 0:")
    assert said.splitlines()[1] == f"the rows before that are in {tmp_path}/out.nc"
    assert [path.name for path in tmp_path.iterdir() if path.suffix != ".yaml"] == ["out.nc"]
    code, shown, said = run("--resume")
    assert (code, shown) == (3, "")
    assert "is of a run that failed: no convergence" in said
    assert "--force starts it again" in said


def test_v_tells_of_the_mesh_and_vv_of_every_step(run):
    quiet, steps = run("-v")[2], run("-vv", "--force")[2]
    assert "cells of 16 Gauss points" in quiet
    assert "Newton iterations" not in quiet
    assert steps.count("Newton iterations") == json.loads(run("--json", "--force")[1])["steps"]
