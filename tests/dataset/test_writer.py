import errno
import os
import signal
import subprocess
import sys
from collections import namedtuple
from pathlib import Path

import netCDF4
import numpy as np
import pytest

from rodloop_cli.dataset import RunWriter, open_run, room
from rodloop_cli.dataset.lock import OutputLock
from rodloop_cli.errors import OutputError


def test_rows_end_up_in_the_named_file_alone(written):
    assert sorted(p.name for p in written.parent.iterdir()) == ["out.nc"]
    with open_run(written) as run:
        assert run.sizes == {"t": 120, "s": 40}
        np.testing.assert_allclose(run.x[7], np.sin(run.s + 0.07), rtol=1e-15)
        assert run.crossing.sum() == 120 - 51
        assert run.attrs["outcome"] == "reached t_end"


def test_existing_result_is_refused_without_force(written, fixed, row):
    before = written.read_bytes()
    with pytest.raises(OutputError, match=r"out\.nc exists; replace it with --force"):
        RunWriter(written, **fixed)
    with RunWriter(written, **fixed, force=True) as forced:
        forced.append(row(0.0))
        assert written.read_bytes() == before, "the old result stays until the new one is whole"
        forced.finish({"outcome": "done"})
    with open_run(written) as run:
        assert run.sizes["t"] == 1


def test_a_result_that_appears_during_the_run_is_not_overwritten(tmp_path, fixed, row):
    path = tmp_path / "out.nc"
    run = RunWriter(path, **fixed)
    run.append(row(0.0))
    path.write_text("precious")
    with pytest.raises(OutputError, match="appeared during the run; the whole result is in"):
        run.finish({"outcome": "done"})
    run.abandon()
    assert path.read_text() == "precious"
    with open_run(run.part, partial=True) as kept:
        assert kept.attrs["outcome"] == "done"


def test_missing_folder_and_folder_as_file(tmp_path, fixed):
    with pytest.raises(OutputError, match=r"no folder .*nowhere; create it"):
        RunWriter(tmp_path / "nowhere" / "out.nc", **fixed)
    with pytest.raises(OutputError, match="is a folder; name a file"):
        RunWriter(tmp_path, **fixed, force=True)


@pytest.mark.parametrize("code", [errno.EACCES, errno.EROFS])
def test_unwritable_folder(tmp_path, fixed, monkeypatch, code):
    def refuse(*_, **__):
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(OutputError, match="no permission to write in"):
        RunWriter(tmp_path / "out.nc", **fixed)


def test_second_run_to_one_output_is_refused(tmp_path, fixed, row):
    path = tmp_path / "out.nc"
    with RunWriter(path, **fixed) as first:
        first.append(row(0.0))
        with pytest.raises(OutputError, match="is being written by another run; wait"):
            RunWriter(path, **fixed, force=True)
        first.append(row(0.1))
        first.finish({})
    with open_run(path) as run:
        assert run.sizes["t"] == 2


def test_lock_is_free_after_release_and_after_a_stale_file(tmp_path):
    lock_file = tmp_path / "out.nc.lock"
    lock_file.touch()  # a killed run's
    lock = OutputLock(tmp_path / "out.nc")
    lock.release()
    lock.release()
    assert not lock_file.exists()
    OutputLock(tmp_path / "out.nc").release()


def test_without_file_locks_the_run_goes_on_with_a_warning(tmp_path, monkeypatch):
    def unsupported(*_):
        raise OSError(errno.ENOLCK, "no locks")

    monkeypatch.setattr("fcntl.flock", unsupported)
    with pytest.warns(UserWarning, match="no file locks here"):
        OutputLock(tmp_path / "out.nc").release()


class Boom(Exception):
    pass


def crash(run, rows, error=Boom):
    with run:
        for r in rows:
            run.append(r)
        raise error


def test_an_exception_keeps_the_rows_in_the_part(tmp_path, fixed, row):
    with pytest.raises(Boom):
        crash(RunWriter(tmp_path / "out.nc", **fixed), [row(0.0), row(0.1), row(0.2)])
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out.nc.part"]
    with open_run(tmp_path / "out.nc", partial=True) as kept:
        assert kept.t.values.tolist() == [0.0, 0.1, 0.2]


def test_an_exception_before_the_first_row_leaves_nothing(tmp_path, fixed):
    with pytest.raises(Boom):
        crash(RunWriter(tmp_path / "out.nc", **fixed), [])
    assert list(tmp_path.iterdir()) == []


def test_bad_attributes_leave_nothing(tmp_path, fixed):
    with pytest.raises(TypeError, match="attribute damped"):
        RunWriter(tmp_path / "out.nc", **(fixed | {"attributes": {"damped": True}}))
    assert list(tmp_path.iterdir()) == []


def test_rows_are_checked_and_a_bad_one_spoils_nothing(tmp_path, fixed, row):
    with RunWriter(tmp_path / "out.nc", **fixed) as run:
        run.append(row(0.0))
        bad = row(0.1)
        bad["moment"] = np.where(np.arange(40) == 3, np.nan, 1.0)
        with pytest.raises(ValueError, match=r"row at t = 0\.1: moment is not finite"):
            run.append(bad)
        with pytest.raises(ValueError, match=r"missing \['area'\], unknown \['aera'\]"):
            run.append({("aera" if k == "area" else k): v for k, v in row(0.1).items()})
        with pytest.raises(ValueError, match="after the one at t = 0"):
            run.append(row(0.0))
        run.append(row(0.2))
        run.finish({})
    with open_run(tmp_path / "out.nc") as result:
        assert result.t.values.tolist() == [0.0, 0.2]


def test_closed_file_takes_no_rows(written, fixed, row):
    run = RunWriter(written, **fixed, force=True)
    run.append(row(0.0))
    run.abandon()
    run.abandon()
    with pytest.raises(ValueError, match="the file is closed"):
        run._open_dataset()


KILLED = """
import os, sys, time
import numpy as np
from rodloop_cli.dataset import RunWriter, writer
from rodloop_cli.dataset.variables import PROFILES, SCALARS
writer.SYNC_SECONDS = 0.0 if sys.argv[2] == "tick" else 100.0
s = np.linspace(0, 2 * np.pi, 40, endpoint=False)
run = RunWriter(sys.argv[1], s=s, segment=np.ones(40, int), attributes={"source": "rodloop"})
for i in range(73):
    run.append({"t": i * 0.1, **{v.name: s for v in PROFILES}, **{v.name: 1.0 for v in SCALARS}})
time.sleep(0.01)
run.flush_if_due()
print("ready", flush=True)
time.sleep(60)
"""


@pytest.mark.parametrize(("mode", "least"), [("tick", 73), ("block", 50)])
def test_killed_writer_leaves_its_rows(tmp_path, mode, least):
    path = tmp_path / "out.nc"
    process = subprocess.Popen([sys.executable, "-c", KILLED, path, mode], stdout=subprocess.PIPE, text=True)
    with process:
        assert process.stdout.readline() == "ready\n"
        with pytest.raises(OutputError, match="is being written; wait until the run ends"):
            open_run(path, partial=True)
        process.send_signal(signal.SIGKILL)
    assert not path.exists()
    with open_run(path, partial=True) as kept:
        assert kept.sizes["t"] == least
        assert kept.t[-1] == pytest.approx((least - 1) * 0.1)
    with pytest.raises(OutputError, match=r"an unfinished run left out\.nc\.part"):
        open_run(path)


def test_after_a_kill_the_next_run_goes_ahead(tmp_path, fixed, row):
    (tmp_path / "out.nc.part").write_bytes(b"leftover")
    (tmp_path / "out.nc.lock").touch()
    with RunWriter(tmp_path / "out.nc", **fixed) as run:
        run.append(row(0.0))
        run.finish({})
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out.nc"]


def test_full_disk_is_noticed_before_the_file_breaks(tmp_path, fixed, row, monkeypatch):
    usage = namedtuple("usage", "total used free")
    run = RunWriter(tmp_path / "out.nc", **fixed)
    run.append(row(0.0))
    monkeypatch.setattr(room.shutil, "disk_usage", lambda _: usage(10**9, 10**9, 1000))
    run.append(row(0.1))
    with pytest.raises(OutputError, match=r"the disk is full .*free some room .*rows up to t = 0 are in out"):
        run.flush()
    run.abandon()
    monkeypatch.undo()
    with open_run(tmp_path / "out.nc", partial=True) as kept:
        assert kept.t.values.tolist() == [0.0]


def test_quota_is_noticed_before_the_file_breaks(tmp_path, fixed, row, monkeypatch):
    def over_quota(*_):
        raise OSError(errno.EDQUOT, "Disk quota exceeded")

    run = RunWriter(tmp_path / "out.nc", **fixed)
    run.append(row(0.0))
    monkeypatch.setattr(room.os, "posix_fallocate", over_quota)
    run._room = room.Room(tmp_path)  # what was tried out before is used up
    run.append(row(0.1))
    with pytest.raises(OutputError, match=r"disk is full \(Disk quota exceeded\).*rows up to t = 0 are in"):
        run.finish({})
    run.abandon()
    with open_run(tmp_path / "out.nc", partial=True) as kept:
        assert kept.t.values.tolist() == [0.0]


def test_refusal_by_hdf5_is_told_in_words(tmp_path, fixed, row, monkeypatch):
    run = RunWriter(tmp_path / "out.nc", **fixed)
    run.append(row(0.0))

    def fail(*_):
        raise RuntimeError("NetCDF: HDF error")

    monkeypatch.setattr(RunWriter, "_write_block", fail)
    run.append(row(0.1))
    with pytest.raises(OutputError, match=r"cannot be written \(NetCDF: HDF error\) and may be damaged"):
        run.finish({})
    run.abandon()


def test_vanished_folder(tmp_path, fixed, row):
    folder = tmp_path / "results"
    folder.mkdir()
    run = RunWriter(folder / "out.nc", **fixed)
    run.append(row(0.0))
    folder.rename(tmp_path / "moved")
    with pytest.raises(OutputError, match=r"the folder .*results is gone"), run:
        run.finish({})
    with open_run(tmp_path / "moved" / "out.nc", partial=True) as kept:
        assert kept.sizes["t"] == 1


def test_interrupt_between_blocks_keeps_what_is_buffered(tmp_path, fixed, row):
    with pytest.raises(KeyboardInterrupt):
        crash(RunWriter(tmp_path / "out.nc", **fixed), [row(0.0), row(0.1)], KeyboardInterrupt)
    with open_run(tmp_path / "out.nc", partial=True) as kept:
        assert kept.sizes["t"] == 2


def test_writing_imports_no_xarray():
    code = "import sys, rodloop_cli.dataset.writer; sys.exit('xarray' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_long_case_text_fits(tmp_path, fixed, row):
    text = "snapshot_times: [" + ", ".join(f"{i / 7}" for i in range(20_000)) + "]\n"
    with RunWriter(tmp_path / "out.nc", **(fixed | {"attributes": {"source": "rodloop", "case": text}})) as run:
        run.append(row(0.0))
        run.finish({})
    with netCDF4.Dataset(tmp_path / "out.nc") as raw:
        assert raw.case == text


def _small_disk(folder: Path) -> bool:
    folder.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(folder)]
    try:
        return subprocess.run(command, check=False, capture_output=True).returncode == 0
    except OSError:
        return False


def test_really_full_disk(tmp_path, fixed, row):
    folder = tmp_path / "small"
    if not _small_disk(folder):
        pytest.skip("needs the right to mount a small file system")
    try:
        run = RunWriter(folder / "out.nc", **fixed)
        with pytest.raises(OutputError, match="the disk is full"):
            crash(run, (row(0.01 * i) for i in range(10_000)))
        with open_run(folder / "out.nc", partial=True) as kept:
            assert kept.sizes["t"] >= 50
            assert np.isfinite(kept.x.values).all()
    finally:
        subprocess.run(["umount", str(folder)], check=True)
