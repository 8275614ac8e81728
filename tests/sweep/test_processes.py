"""Sweeps with real processes: kills at any time, Ctrl-C, two at once."""

import json
import os
import random
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from multiprocessing import get_context
from pathlib import Path

import netCDF4
import pytest

from rodloop_cli.sweep import run_sweep
from rodloop_cli.sweep.columns import Status
from rodloop_cli.sweep.slots import ProcessSlots, WorkerDied

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")


@pytest.fixture
def start():
    """Starts ``rodloop sweep``, each in a session of its own; none outlives the test."""
    started = []

    def sweep(path, folder, *more):
        command = [sys.executable, "-m", "rodloop_cli", "sweep", str(path), "-o", str(folder), *more]
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        started.append(subprocess.Popen(command, start_new_session=True, **pipes))
        return started[-1]

    yield sweep
    for process in started:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def rows(folder):
    try:
        lines = (folder / "manifest.jsonl").read_text().split("\n")[:-1]
    except FileNotFoundError:
        return []
    return [json.loads(line) for line in lines]


def until(condition, seconds=30.0):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "nothing happened"
        time.sleep(0.005)


def workers_of(sweep, count=2):
    """Waits for the processes that a sweep starts and that work: not the resource tracker of multiprocessing."""
    command = ["ps", "-ww", "-o", "pid=", "-o", "args=", "--ppid", str(sweep.pid)]
    workers = []
    while len(workers) < count:
        assert sweep.poll() is None, "the sweep ended"
        listed = subprocess.run(command, capture_output=True, text=True, check=False)
        workers = [int(line.split()[0]) for line in listed.stdout.splitlines() if "spawn_main" in line]
    return workers


def statuses(folder):
    with netCDF4.Dataset(folder / "sweep.nc") as dataset:
        return Counter(dataset["status"][:].ravel().tolist())


@pytest.mark.parametrize("output", ["fields", "scalars"])
def test_a_sweep_killed_at_random_ends_complete_with_nothing_run_twice(start, sweep_file, tmp_path, output):
    folder, dice, members = tmp_path / "out", random.Random(output), 240
    path = sweep_file(f"p: {{linspace: [1, 48, {members}]}}", more=f"output: {output}")
    for wanted in (dice.randint(10 * kill, 10 * kill + 6) for kill in (1, 2, 3)):
        sweep = start(path, folder)
        workers = workers_of(sweep)
        until(lambda least=wanted: len(rows(folder)) >= least)
        time.sleep(dice.random() * 0.02)
        sweep.kill()
        sweep.communicate()
        until(lambda pids=workers: not any(is_alive(pid) for pid in pids))
    assert len(rows(folder)) < members
    shown = start(path, folder, "--json").communicate(timeout=60)[0]
    assert json.loads(shown)["failed"] == 0
    ended = Counter(row["member"] for row in rows(folder))
    assert (len(ended), set(ended.values())) == (members, {1})
    assert statuses(folder) == {Status.reached_end: members}
    assert not list(folder.glob("*.part"))


def is_alive(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text("ascii").rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_a_killed_worker_costs_one_member(start, sweep_file, tmp_path):
    folder, path = tmp_path / "out", sweep_file("p: {linspace: [1, 30, 30]}", more="output: scalars")
    sweep = start(path, folder, "-j", "2")
    workers = workers_of(sweep)
    until(lambda: len(rows(folder)) >= 4)
    os.kill(workers[0], signal.SIGKILL)
    shown, told = sweep.communicate(timeout=60)
    assert (sweep.returncode, shown) == (4, f"{folder}/sweep.nc\n")
    assert "the worker process died (SIGKILL, perhaps out of memory)" in told
    assert statuses(folder) == {Status.reached_end: 29, Status.failed: 1}
    again = start(path, folder, "--json")
    assert json.loads(again.communicate(timeout=60)[0])["ran"] == 1
    assert (again.returncode, statuses(folder)) == (0, {Status.reached_end: 30})


def test_ctrl_c_stops_at_once_and_keeps_what_is_done(start, sweep_file, tmp_path):
    members = 1000  # enough for a second or more, should the test itself have to wait for the machine
    folder, path = tmp_path / "out", sweep_file(f"p: {{linspace: [1, 200, {members}]}}", more="output: scalars")
    sweep = start(path, folder)
    until(lambda: len(rows(folder)) >= 3)
    os.killpg(sweep.pid, signal.SIGINT)  # as a terminal does: to the workers too
    told = sweep.communicate(timeout=10)[1]
    assert sweep.returncode == 130
    assert told.startswith("interrupted; ")
    assert "Traceback" not in told
    done = len(rows(folder))
    assert statuses(folder) == {Status.reached_end: done, Status.not_run: members - done}


def test_two_sweeps_in_one_folder_share_the_work(start, sweep_file, tmp_path):
    folder, path = tmp_path / "out", sweep_file("p: {linspace: [1, 30, 30]}")
    sweeps = [start(path, folder, "--json", "-j", "1") for _ in range(2)]
    ran = [json.loads(sweep.communicate(timeout=60)[0])["ran"] for sweep in sweeps]
    assert [sweep.returncode for sweep in sweeps] == [0, 0]
    assert sum(ran) == 30
    assert Counter(row["member"] for row in rows(folder)).most_common(1)[0][1] == 1
    assert statuses(folder) == {Status.reached_end: 30}


def test_any_executor_will_do(sweep_file, tmp_path):
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        run_sweep(sweep_file(), tmp_path, executor=pool)
    assert statuses(tmp_path) == {Status.reached_end: 2}


def test_slots_pass_on_results_and_exceptions_and_outlive_a_worker():
    with ProcessSlots(1) as slots:
        assert slots.submit(divmod, 7, 2).result() == (3, 1)
        with pytest.raises(ZeroDivisionError):
            slots.submit(divmod, 7, 0).result()
        with pytest.raises(WorkerDied, match="exit code 3"):
            slots.submit(os._exit, 3).result()
        with pytest.raises(TypeError, match="pickle"):
            slots.submit(threading.Lock().acquire).result()
        assert slots.submit(os.getenv, "OMP_NUM_THREADS").result() == "1"


def test_a_worker_loads_no_more_than_it_needs():
    code = (
        "import sys, rodloop_cli.sweep.worker\n"
        "sys.exit(' '.join({'xarray', 'matplotlib', 'pandas', 'tqdm'} & set(sys.modules)) or 0)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (0, "")
