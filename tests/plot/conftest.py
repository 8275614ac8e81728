"""Small results to draw: a run past its first crossing, a damped homogeneous one, a run that was killed."""

import netCDF4
import pytest

from rodloop_cli.case import parse_case
from rodloop_cli.dataset import RunWriter, open_run
from rodloop_cli.simulation import Run

SMALL = "snapshots: 14\noutput_points: 48\ntol: 1.0e-3\n"
CROSSING = "title: Past the crossing\nstiffness_ratio: 5\np: 16\nt_end: 0.7\nstop_at: []\n" + SMALL
DAMPED = "title: Costs $5\np: -5\nzeta_perp: 2\nt_end: 1\nperturbation: [{mode: 2, amplitude: 5.0e-2}]\n" + SMALL


def write(path, text):
    run = Run.of(parse_case(text))
    with RunWriter(path, s=run.recorder.s, segment=run.recorder.segment, attributes=run.attributes) as writer:
        run.into(writer)
    return path


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("results")


@pytest.fixture(scope="session")
def crossing_file(folder):
    return write(folder / "crossing.nc", CROSSING)


@pytest.fixture(scope="session")
def damped_file(folder):
    return write(folder / "damped.nc", DAMPED)


@pytest.fixture
def crossing(crossing_file):
    with open_run(crossing_file) as dataset:
        yield dataset.load()


@pytest.fixture
def damped(damped_file):
    with open_run(damped_file) as dataset:
        yield dataset.load()


@pytest.fixture
def changed(crossing_file, tmp_path):
    """Makes a copy of a result in which a variable or attributes differ."""

    def make(name=None, values=None, name_of_file="changed.nc", **attributes):
        path = tmp_path / name_of_file
        path.write_bytes(crossing_file.read_bytes())
        with netCDF4.Dataset(path, "a") as raw:
            if name:
                raw.variables[name][...] = values
            for key, value in attributes.items():
                raw.delncattr(key) if value is None else raw.setncattr(key, value)
        return path

    return make
