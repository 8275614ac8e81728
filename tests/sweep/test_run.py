"""Sweeps from the command line to sweep.nc: what runs, what is skipped, what is kept."""

import errno
import json
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from types import SimpleNamespace

import netCDF4
import numpy as np
import pytest
import xarray as xr

from rodloop_cli.cli import main
from rodloop_cli.dataset import open_run
from rodloop_cli.errors import ConvergenceError, OutputError
from rodloop_cli.simulation import Run
from rodloop_cli.sweep import gather, open_sweep, run_sweep
from rodloop_cli.sweep.columns import Status
from rodloop_cli.sweep.executors import Crew
from rodloop_cli.sweep.run import Sweep


def sweep(path, folder, *more, code=0):
    assert main(["sweep", str(path), "-o", str(folder), *more]) == code


@pytest.fixture(autouse=True)
def in_this_process(monkeypatch):
    """Workers are threads here: starting processes is what takes time, and test_processes does it."""
    with ThreadPoolExecutor(1) as pool:
        yield monkeypatch.setattr("rodloop_cli.sweep.executors._processes", lambda _: nullcontext(Crew(pool, 2)))


def counts(capsys):
    shown = json.loads(capsys.readouterr().out)
    return shown["ran"], shown["was_done"], shown["failed"]


def listed(path, folder, capsys, *more):
    sweep(path, folder, "--dry-run", *more)
    return capsys.readouterr().out.split()


def rows(folder):
    return [json.loads(line) for line in (folder / "manifest.jsonl").read_text().splitlines()]


def test_a_changed_grid_runs_only_what_is_new(sweep_file, tmp_path, capsys):
    folder, path = tmp_path / "out", sweep_file("p: [4, 8]")
    assert listed(path, folder, capsys) == ["p=8", "p=4"]  # longest first
    assert not folder.exists()
    sweep(path, folder, "--json")
    assert counts(capsys) == (2, 0, 0)
    sweep(path, folder, "--json")
    assert counts(capsys) == (0, 2, 0)
    grown = sweep_file("p: [4, 6, 8]")
    assert listed(grown, folder, capsys) == ["p=6"]
    sweep(grown, folder, "-j", "1")
    assert capsys.readouterr().out == f"{folder}/sweep.nc\n"
    with open_sweep(folder).summary as summary:
        assert summary["p"].values.tolist() == [4, 6, 8]
        assert (summary["status"] == Status.reached_end).all()
    # A change of the base changes every member, though not its name.
    assert listed(grown, folder, capsys, "--set", "zeta_perp=1") == ["p=8", "p=6", "p=4"]
    assert {p.name for p in folder.iterdir()} == {"p=4.nc", "p=6.nc", "p=8.nc", "manifest.jsonl", "sweep.nc"}


def test_a_file_of_the_same_key_is_enough(sweep_file, tmp_path, capsys):
    """Killed between the result file and its line in the manifest, or the manifest lost."""
    folder, path = tmp_path / "out", sweep_file()
    sweep(path, folder)
    before = rows(folder)
    (folder / "manifest.jsonl").unlink()
    assert listed(path, folder, capsys) == [str(folder / "sweep.nc")]
    assert not (folder / "manifest.jsonl").exists()
    sweep(path, folder, "--json")
    assert counts(capsys) == (0, 2, 0)
    timeless = [{k: v for k, v in row.items() if k not in {"cpu_seconds", "wall_seconds"}} for row in before]
    assert sorted(rows(folder), key=str) == sorted(timeless, key=str)


def test_a_file_that_is_gone_or_of_another_content_is_made_again(sweep_file, tmp_path, capsys):
    folder, path = tmp_path / "out", sweep_file()
    sweep(path, folder)
    (folder / "p=4.nc").unlink()
    capsys.readouterr()
    assert listed(path, folder, capsys) == ["p=4"]
    sweep(path, folder, "--set", "zeta_perp=1")
    told = f"{folder}: 1 results there are of other cases and will be replaced, each when the new one is complete"
    assert told in capsys.readouterr().err
    assert listed(path, folder, capsys) == ["p=8", "p=4"]


def test_scalars_alone_leave_no_files_and_the_same_scalars(sweep_file, tmp_path, capsys):
    path = sweep_file(more="output: scalars")
    sweep(path, tmp_path / "scalars")
    sweep(path, tmp_path / "fields", "--set", "output=fields")
    assert {p.name for p in (tmp_path / "scalars").iterdir()} == {"manifest.jsonl", "sweep.nc"}
    costs = ["solver_seconds", "cpu_seconds", "wall_seconds"]
    with open_sweep(tmp_path / "scalars").summary as ours, open_sweep(tmp_path / "fields").summary as theirs:
        xr.testing.assert_equal(ours.drop_vars(costs), theirs.drop_vars(costs))
    capsys.readouterr()
    sweep(path, tmp_path / "scalars", "--json")
    assert counts(capsys) == (0, 2, 0)
    # Not even a worker that has run them before remembers scalars that were thrown away.
    (tmp_path / "scalars" / "manifest.jsonl").unlink()
    sweep(path, tmp_path / "scalars", "--json")
    assert counts(capsys) == (2, 0, 0)
    # Now the fields are wanted: scalars do not make them.
    assert listed(path, tmp_path / "scalars", capsys, "--set", "output=fields") == ["p=8", "p=4"]


def test_a_failed_member_is_a_row_and_is_tried_again(sweep_file, tmp_path, capsys, monkeypatch):
    begin = Run.of

    def failing(case):
        if case.p == 8:
            raise ConvergenceError("the equations just after the load is switched on cannot be solved")
        return begin(case)

    monkeypatch.setattr(Run, "of", failing)
    folder, path = tmp_path / "out", sweep_file("p: [4, 8]")
    sweep(path, folder, code=4)
    shown = capsys.readouterr()
    assert shown.out == f"{folder}/sweep.nc\n"
    assert shown.err.splitlines()[-1].startswith("1 of 2 members failed; the others are kept")
    assert "p=8: the equations just after the load is switched on cannot be solved" in shown.err
    with open_sweep(folder).summary as summary:
        assert summary["status"].values.tolist() == [Status.reached_end, Status.failed]
        assert summary["outcome"].values[1].startswith("the equations")
    assert listed(path, folder, capsys) == ["p=8"]
    monkeypatch.setattr(Run, "of", begin)
    sweep(path, folder, "--json")
    assert counts(capsys) == (1, 1, 0)


def test_what_a_failed_member_has_computed_is_kept(sweep_file, tmp_path, capsys, monkeypatch):
    record = Run._record

    def failing(run, step, *rest, **more):
        if run.case.p == 8 and step.start.time > 0.005:
            raise ConvergenceError("no convergence at t = 0.005")
        return record(run, step, *rest, **more)

    monkeypatch.setattr(Run, "_record", failing)
    folder, path = tmp_path / "out", sweep_file("p: [4, 8]", base="p: 4, dt: 0.002")
    sweep(path, folder, code=4)
    with open_sweep(folder).summary as summary, open_run(folder / "p=8.nc") as motion:
        assert summary["outcome"].sel(p=8) == motion.attrs["outcome"] == "no convergence at t = 0.005"
        assert summary["maximum_displacement"].sel(p=8) >= 0
    capsys.readouterr()
    assert listed(path, folder, capsys) == ["p=8"]


@pytest.mark.parametrize(
    ("error", "outcome"),
    [
        (MemoryError(), "out of memory"),
        (OSError(errno.ENOSPC, "No space left on device"), "[Errno 28] No space left on device"),
        (ZeroDivisionError("division by zero"), "internal error: ZeroDivisionError: division by zero"),
    ],
)
def test_whatever_a_member_fails_of_the_others_finish(sweep_file, tmp_path, capsys, monkeypatch, error, outcome):
    run_of = Run.of

    def failing(case):
        if case.p == 8:
            raise error
        return run_of(case)

    monkeypatch.setattr(Run, "of", failing)
    folder, path = tmp_path / "out", sweep_file("p: [4, 8, 16]", more="output: scalars")
    sweep(path, folder, "--json", code=4)
    assert counts(capsys) == (2, 0, 1)
    with open_sweep(folder).summary as summary:
        assert summary["outcome"].sel(p=8) == outcome
    monkeypatch.undo()
    sweep(path, folder, "--json", "-j", "1")
    assert counts(capsys) == (1, 2, 0)


def test_a_full_disk_is_a_failed_member(sweep_file, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(free=1000))
    sweep(sweep_file("p: [4]"), tmp_path / "out", code=4)
    assert "the disk is full" in capsys.readouterr().err


def test_shards_together_make_the_whole(sweep_file, tmp_path, capsys):
    folder, path = tmp_path / "out", sweep_file("p: [4, 5, 6]", more="output: scalars")
    sweep(path, folder, "--shard", "1/2", "-j", "1")
    assert capsys.readouterr().out == f"{folder}\n"
    sweep(path, folder, "--shard", "2/2", "-j", "1")
    capsys.readouterr()
    sweep(path, folder, "--json")
    assert counts(capsys) == (0, 3, 0)
    assert main(["sweep", str(path), "--shard", "3/2"]) == 2


def test_sweep_nc_is_clean_cf(sweep_file, tmp_path):
    grid = "p: [8, 4]; scheme: [radau]; perturbation.0.phase: [0, 1]"
    path = sweep_file(
        grid, base="p: 4, perturbation: [{mode: 2, amplitude: 1e-3}]", more="output: scalars\nzip: {k: [0.5, 0.4]}"
    )
    with netCDF4.Dataset(run_sweep(path, tmp_path / "out", jobs=1)) as raw:
        assert raw.Conventions == "CF-1.11"
        assert raw["p"][:].tolist() == [4, 8]
        assert raw["perturbation_0_phase"].units == "rad"
        assert raw["scheme_label"][:].tolist() == ["radau"]
        assert raw["k"].dimensions == ("zip",)
        assert raw["growth_rate"].coordinates == "scheme_label k"
        assert not any("_FillValue" in raw[name].ncattrs() for name in raw.dimensions if name in raw.variables)
        assert all(v.long_name and (v.dtype is str or v.units) for v in raw.variables.values())
        assert raw["lobes_final"].dtype == np.int32


def test_open_sweep_reaches_the_motion_of_members(sweep_file, tmp_path):
    run_sweep(sweep_file("p: [4, 8]; scheme: [radau]"), tmp_path, jobs=1)
    collection = open_sweep(tmp_path / "sweep.nc")
    with collection.member(p=7.9, scheme="radau") as motion:
        assert "p: 8.0\n" in motion.attrs["case"]
        assert motion.sizes["t"] == 8
    with pytest.raises(OutputError, match="several members; say which p"):
        collection.path()
    values = [values for values, motion in collection.members() if not motion.close()]
    assert values == [{"p": 4, "scheme": "radau"}, {"p": 8, "scheme": "radau"}]
    collection.summary.close()


def test_a_folder_without_sweep_nc_is_no_sweep(tmp_path):
    with pytest.raises(OutputError, match="no such file"):
        open_sweep(tmp_path)
    (tmp_path / "sweep.nc").write_text("no netCDF")
    with pytest.raises(OutputError, match="damaged"):
        open_sweep(tmp_path)


def test_two_sweeps_of_a_folder_may_end_together(sweep_file, tmp_path, monkeypatch):
    path, folder, write = sweep_file(), tmp_path / "out", gather._write

    def write_while_another_does(*arguments):
        monkeypatch.setattr(gather, "_write", write)
        gather.gather(Sweep.of(path, folder).plan, folder)
        write(*arguments)

    monkeypatch.setattr(gather, "_write", write_while_another_does)
    run_sweep(path, folder)
    assert (open_sweep(folder).summary["status"] == Status.reached_end).all()
    assert not list(folder.glob("*.part"))


def test_an_output_that_is_a_file_is_refused(sweep_file, tmp_path, capsys):
    sweep(sweep_file(), tmp_path / "grid.yaml", code=2)
    assert capsys.readouterr().err.endswith("grid.yaml is not a folder; choose another place with -o\n")


def test_a_bar_is_shown_on_a_terminal_only(sweep_file, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    sweep(sweep_file("p: [4]", more="output: scalars"), tmp_path / "out")
    assert "member" in capsys.readouterr().err
