"""Sweeps past one machine; each skipped where its optional package is absent."""

import os
import shutil
import signal
import subprocess
import sys
from collections import Counter

import netCDF4
import pytest

from rodloop_cli.cli import main
from rodloop_cli.sweep.columns import Status
from rodloop_cli.sweep.run import Sweep


def statuses(folder):
    with netCDF4.Dataset(folder / "sweep.nc") as dataset:
        return Counter(dataset["status"][:].ravel().tolist())


# dask warns of its own use of asyncio and of the worker that the test kills.
@pytest.mark.filterwarnings("ignore")
def test_a_dask_cluster_loses_a_worker_and_no_member(sweep_file, tmp_path):
    distributed = pytest.importorskip("distributed")
    folder = tmp_path / "out"
    sweep = Sweep.of(sweep_file("p: {linspace: [1, 24, 24]}"), folder)
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
    ) as cluster:
        with distributed.Client(cluster) as client:
            victim = next(iter(client.run(os.getpid).values()))

        def kill_one(_):
            if sweep.tally.ran == 5:
                os.kill(victim, signal.SIGKILL)

        sweep.run("dask", scheduler=cluster.scheduler_address, watcher=kill_one)
    assert sweep.tally.ran + sweep.tally.was_done == 24
    assert statuses(folder) == {Status.reached_end: 24}
    lines = (folder / "manifest.jsonl").read_text().splitlines()
    assert len(lines) == 24


def test_mpi_ranks_run_members(sweep_file, tmp_path):
    pytest.importorskip("mpi4py")
    mpiexec = shutil.which("mpiexec")
    if mpiexec is None:
        pytest.skip("no mpiexec")
    sweep = ["sweep", str(sweep_file("p: {linspace: [1, 6, 6]}")), "-o", str(tmp_path / "out"), "--executor", "mpi"]
    command = [mpiexec, "-n", "3", sys.executable, "-m", "mpi4py.futures", "-m", "rodloop_cli", *sweep]
    ran = subprocess.run(command, capture_output=True, text=True, check=False, timeout=100)
    assert ran.returncode == 0, ran.stderr
    assert statuses(tmp_path / "out") == {Status.reached_end: 6}


def test_dask_needs_the_address_of_a_scheduler(sweep_file, tmp_path, capsys):
    command = ["sweep", str(sweep_file()), "-o", str(tmp_path / "out"), "--executor", "dask"]
    assert main(command) == 2
    assert "--scheduler tcp://host:8786" in capsys.readouterr().err
    assert main([*command[:-1], "process", "--scheduler", "tcp://host:8786"]) == 2
    assert "--scheduler goes with --executor dask" in capsys.readouterr().err


def test_a_scheduler_that_is_not_there_is_said_so(sweep_file, tmp_path, capsys):
    pytest.importorskip("distributed")
    command = ["sweep", str(sweep_file()), "-o", str(tmp_path / "out"), "--executor", "dask"]
    assert main([*command, "--scheduler", "nonsense://x"]) == 2
    assert "no dask scheduler at nonsense://x" in capsys.readouterr().err
