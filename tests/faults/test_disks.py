"""Disks and folders that fail, damaged files, and two runs to one output."""

import contextlib
import io
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from rodloop_cli.cli import main
from rodloop_cli.dataset import open_run
from rodloop_cli.errors import OutputError

from .program import CASE, run, started, struck

SHORT = CASE.replace("t_end: 9.6", "t_end: 1.0")


@pytest.fixture
def case(tmp_path) -> Path:
    path = tmp_path / "case.yaml"
    path.write_text(SHORT)
    return path


def quickly(*arguments: str) -> tuple[int, str]:
    """The program in this process: the exit code, and what it said on stderr."""
    with contextlib.redirect_stderr(io.StringIO()) as said, contextlib.redirect_stdout(io.StringIO()):
        return main(["-q", *arguments]), said.getvalue()


def one_line(said: str) -> str:
    lines = said.strip().splitlines()
    assert len(lines) == 1, said
    assert "Traceback" not in said
    return lines[0]


@pytest.mark.parametrize("size", [0, 60_000, 400_000])
def test_a_file_that_cannot_grow(case, tmp_path, size):
    output = tmp_path / "out.nc"
    code, said = run("-q", "run", str(case), "-o", str(output), "--set", "output_points=2000", file_size=size)
    assert code == 2
    assert str(output) in one_line(said)
    assert not output.exists()
    code, said = run("-q", "run", str(case), "-o", str(output), "--resume")
    assert code == 0, said


@pytest.mark.skipif(os.geteuid() != 0, reason="needs to mount a small disk")
def test_a_full_disk(case, tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=16m", "tmpfs", str(disk)]
    if subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("no small disk can be mounted here")
    try:
        code, said = run("-q", "run", str(case), "-o", str(disk / "out.nc"), "--set", "output_points=2000")
        assert code == 2
        assert "full" in one_line(said)
        with open_run(disk / "out.nc", partial=True) as rows:
            assert rows.sizes["t"] > 0
    finally:
        subprocess.run(["umount", str(disk)], check=True)


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is forbidden to root")
def test_a_folder_that_cannot_be_written(case, tmp_path):
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o500)
    code, said = run("-q", "run", str(case), "-o", str(folder / "out.nc"))
    assert code == 2
    assert "permission" in one_line(said)


def test_a_folder_that_is_not_there(case, tmp_path):
    code, said = run("-q", "run", str(case), "-o", str(tmp_path / "none" / "out.nc"))
    assert code == 2
    assert "create it" in one_line(said)


def test_a_folder_that_vanishes(tmp_path):
    case, folder = tmp_path / "case.yaml", tmp_path / "folder"
    case.write_text(CASE)
    folder.mkdir()
    process = started("-q", "run", str(case), "-o", str(folder / "out.nc"))
    while process.poll() is None and not (folder / "out.nc.part").exists():
        pass
    shutil.rmtree(folder)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 2
    assert "gone" in one_line(said)


@pytest.fixture(scope="module")
def left_behind(tmp_path_factory) -> Path:
    """A folder with a case, and what a run of it left when it was killed."""
    folder = tmp_path_factory.mktemp("killed")
    (folder / "case.yaml").write_text(CASE)
    arguments = ("run", str(folder / "case.yaml"), "-o", str(folder / "out.nc"))
    code, said = struck(9, 1.0, folder / "out.nc.part", *arguments)
    assert code == -9, said
    return folder


DAMAGES = {
    "empty": lambda data: b"",
    "half": lambda data: data[: len(data) // 2],
    "one byte short": lambda data: data[:-1],
    "zeros inside": lambda data: data[:600] + bytes(2000) + data[2600:],
    "zeros at the end": lambda data: data[:-3000] + bytes(3000),
    "other words": lambda data: b"not a file of this kind" * 100,
}


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("suffix", [".part", ".checkpoint"])
def test_a_damaged_remainder_is_noticed(left_behind, tmp_path, suffix, damage):
    for file in left_behind.iterdir():
        shutil.copy(file, tmp_path)
    case, output = tmp_path / "case.yaml", tmp_path / "out.nc"
    remainder = tmp_path / f"out.nc{suffix}"
    remainder.write_bytes(DAMAGES[damage](remainder.read_bytes()))
    code, said = quickly("run", str(case), "-o", str(output), "--resume")
    if code:
        assert code == 2
        assert "without --resume" in one_line(said)
        assert quickly("run", str(case), "-o", str(output))[0] == 0
    with open_run(output) as whole:
        assert whole.sizes["t"] == 100
        assert np.isfinite(whole.x.to_numpy()).all()
        assert float(abs(whole.x).max()) < 10


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_result_is_refused_or_read(case, tmp_path, damage):
    output = tmp_path / "out.nc"
    assert quickly("run", str(case), "-o", str(output))[0] == 0
    output.write_bytes(DAMAGES[damage](output.read_bytes()))
    with contextlib.suppress(OutputError), open_run(output) as whole:
        whole.load()
    code, said = quickly("plot", str(output), "-o", str(tmp_path / "figure.png"))
    assert "internal error" not in said
    assert code in {0, 2}
    assert code == 0 or one_line(said)


def test_two_runs_to_one_output(tmp_path):
    case, output = tmp_path / "case.yaml", tmp_path / "out.nc"
    case.write_text(CASE)
    first = started("-q", "run", str(case), "-o", str(output))
    while not output.with_name("out.nc.part").exists() and first.poll() is None:
        pass
    code, said = run("-q", "run", str(case), "-o", str(output), "--force")
    assert code == 2
    assert "another run" in one_line(said)
    first.communicate(timeout=60)
    assert first.returncode == 0
    with open_run(output) as whole:
        assert whole.sizes["t"] == 100
