"""A run that was interrupted and continued equals the uninterrupted one."""

from pathlib import Path

import numpy as np
import pytest

from rodloop_cli.case import parse_case
from rodloop_cli.dataset import RunWriter, open_run
from rodloop_cli.dataset.checkpoint import checkpoint_path
from rodloop_cli.errors import Interrupted
from rodloop_cli.march.loop import Marcher
from rodloop_cli.simulation import Run
from rodloop_cli.simulation.resume import Keeper, resumed

CASES = {
    "radau": "p: 3.8\nstiffness_ratio: 5\nt_end: 1.5\nzeta_perp: 0.3\ntol: 1e-4\n",
    "refined": "p: 16\nt_end: 0.9\ntol: 1e-5\nperturbation: [{mode: 3, amplitude: 1e-2}]\n",
    "hard": "p: 0\nt_end: 0.05\ntol: 1e-2\nperturbation: [{mode: 20, amplitude: 0.0075}]\n",
    "settled": "p: 1\nzeta_perp: 300\nstiffness_ratio: 2\nt_end: 3000\ndt: 5\nstop_at: [settled]\n",
    "bdf2": "p: 3.8\nt_end: 0.5\nscheme: bdf2\nN: 40\ndt: 0.01\nperturbation: [{mode: 2, amplitude: 1e-2}]\n",
}


def writer_of(path: Path, run: Run, rows: int = 0) -> RunWriter:
    recorder = run.recorder
    return RunWriter(path, s=recorder.s, segment=recorder.segment, attributes=run.attributes, resume=rows)


def interrupted_after(steps: int, path: Path, text: str) -> None:
    run = Run.of(parse_case(text))
    writer = writer_of(path, run)
    keeper = Keeper(writer, run)

    def ask(_: float) -> None:
        keeper.interrupted = "interrupted" if run.work.steps >= steps else None

    with writer, pytest.raises(Interrupted, match="continue with --resume"):
        run.into(writer, ask, keeper)


@pytest.mark.parametrize("name", CASES)
def test_a_continued_run_equals_the_uninterrupted_one(tmp_path: Path, name: str) -> None:
    continued_equals_uninterrupted(tmp_path, name, steps=40 if name == "settled" else 7)


def test_so_does_one_that_goes_on_with_fewer_stages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As a run does on which Newton fails often: here the first failure is taken to be the last straw."""
    monkeypatch.setattr("rodloop_cli.march.loop.MANY_FAILURES", 1)
    used = []
    use_stages = Marcher.use_stages
    monkeypatch.setattr(Marcher, "use_stages", lambda marcher, n: used.append(n) or use_stages(marcher, n))
    continued_equals_uninterrupted(tmp_path, "hard", steps=7)
    assert used.count(3) >= 3


@pytest.mark.parametrize(("name", "steps"), [("bdf2", 1), ("bdf2", 2), ("bdf2", 50)])
def test_so_does_one_that_was_interrupted_early_or_at_the_end(tmp_path: Path, name: str, steps: int) -> None:
    continued_equals_uninterrupted(tmp_path, name, steps)


def continued_equals_uninterrupted(tmp_path: Path, name: str, steps: int) -> None:
    whole, path = tmp_path / "whole.nc", tmp_path / "parts.nc"
    run = Run.of(parse_case(CASES[name]))
    with writer_of(whole, run) as writer:
        run.into(writer)
    interrupted_after(steps, path, CASES[name])
    assert checkpoint_path(path).exists()

    again = Run.of(parse_case(CASES[name]))
    rows = resumed(path, again)
    assert rows > 0
    with writer_of(path, again, rows) as writer:
        again.revisit(writer.stored())
        again.into(writer)

    with open_run(whole) as first, open_run(path) as second:
        assert first.sizes == second.sizes
        for variable in first.data_vars:
            np.testing.assert_allclose(second[variable], first[variable], rtol=0, atol=1e-12, err_msg=str(variable))
        totals = [f"total_{name}" for name in ("steps", "newton_iterations", "refinements", "cells")]
        same = ("outcome", *totals, "largest_energy_residual")
        assert [first.attrs[key] for key in same] == [second.attrs[key] for key in same]
        for key in (key for key in first.attrs if key.startswith("lobe_event")):
            np.testing.assert_array_equal(first.attrs[key], second.attrs[key])


def test_a_checkpoint_of_another_case_is_not_used(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    interrupted_after(5, path, CASES["radau"])
    other = Run.of(parse_case(CASES["radau"].replace("3.8", "3.9")))
    assert resumed(path, other) == 0


def test_a_damaged_checkpoint_is_not_used(tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    interrupted_after(5, path, CASES["radau"])
    checkpoint = checkpoint_path(path)
    checkpoint.write_bytes(checkpoint.read_bytes()[:-2000])
    assert resumed(path, Run.of(parse_case(CASES["radau"]))) == 0
