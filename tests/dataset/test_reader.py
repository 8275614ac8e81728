import netCDF4
import numpy as np
import pytest
import xarray as xr

from rodloop_cli.dataset import MemoryRows, open_run
from rodloop_cli.dataset.variables import TABLE
from rodloop_cli.errors import OutputError


def test_memory_and_file_hold_the_same(written, fixed, row):
    rows = MemoryRows(**fixed)
    for t in np.arange(120) / 100:
        rows.append(row(float(t)))
    rows.flush_if_due()
    rows.finish({"outcome": "reached t_end", "total_steps": 12, "total_wall_time": 0.5})
    with open_run(written) as run:
        xr.testing.assert_identical(rows.dataset(), run.load())
        assert {n: v.dtype for n, v in run.variables.items()} == {
            n: v.dtype for n, v in rows.dataset().variables.items()
        }


def test_saved_again_it_is_still_a_result(written, tmp_path):
    with open_run(written) as run:
        run.to_netcdf(tmp_path / "copy.nc")
        with open_run(tmp_path / "copy.nc") as copy:
            xr.testing.assert_identical(run, copy)
    with netCDF4.Dataset(tmp_path / "copy.nc") as raw:
        assert raw.dimensions["t"].isunlimited()
        assert not any("_FillValue" in v.ncattrs() for v in raw.variables.values())


def test_cf_basics(written):
    with netCDF4.Dataset(written) as raw:
        assert raw.Conventions == "CF-1.11"
        assert raw.dimensions["t"].isunlimited()
        assert set(raw.variables) == {v.name for v in TABLE}
        for variable in raw.variables.values():
            assert variable.long_name
            assert variable.units == ("rad" if variable.name == "theta" else "1")
            assert "_FillValue" not in variable.ncattrs()
        crossing = raw.variables["crossing"]
        assert crossing.flag_values.dtype == crossing.dtype
        assert len(crossing.flag_meanings.split()) == len(crossing.flag_values)
        assert not {"axis", "standard_name"} & set(raw.variables["t"].ncattrs())
        s = raw.variables["s"][:]
        assert s[0] == 0.0
        assert s[-1] < 2.0 * np.pi


def test_provenance(written):
    with open_run(written) as run:
        assert run.attrs["title"] == "Föppl's loop"
        assert run.attrs["history"].endswith("Z: rodloop run a.yaml")
        assert run.attrs["source"].startswith("rodloop ")
        assert run.attrs["version_numpy"] == np.__version__
        assert {"version_rodloop", "version_python", "version_scipy", "version_netCDF4"} <= set(run.attrs)
        assert run.attrs["case"].startswith("p: 3.8")


def test_chunks_hold_many_rows(written):
    with netCDF4.Dataset(written) as raw:
        assert raw.variables["x"].chunking() == [50, 40]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "no such file"),
        (b"", "is not a netCDF-4 file"),
        (b"title: a case file\n", "is not a netCDF-4 file"),
        (b"CDF\x01" + bytes(100), "is not a netCDF-4 file"),
        (b"\x89HDF\r\n\x1a\n" + bytes(range(256)), "is damaged and cannot be read"),
    ],
)
def test_what_is_no_result(tmp_path, content, message):
    path = tmp_path / "a.nc"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(OutputError, match=message):
        open_run(path)


@pytest.mark.parametrize("partial", [False, True])
@pytest.mark.parametrize("path", [".", "..", "/", ""])
def test_folders_without_a_name_are_folders_too(path, partial):
    with pytest.raises(OutputError, match="is a folder, not a result file"):
        open_run(path, partial=partial)


def test_a_name_that_no_file_can_have():
    with pytest.raises(OutputError, match=r"cannot be read|no such file"):
        open_run("a" * 300)


def test_folder_and_part_are_told_apart(tmp_path):
    with pytest.raises(OutputError, match="is a folder"):
        open_run(tmp_path)
    with pytest.raises(OutputError, match="did not finish; partial=True"):
        open_run(tmp_path / "out.nc.part")
    with pytest.raises(OutputError, match="no such file"):
        open_run(tmp_path / "out.nc.part", partial=True)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.999])
def test_truncated(written, share):
    whole = written.read_bytes()
    written.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(OutputError, match="is damaged and cannot be read"):
        open_run(written)


def foreign(path, change):
    """A file laid out like a result but for `change`, a function of the open file."""
    with netCDF4.Dataset(path, "w") as raw:
        raw.source = "rodloop 1"
        raw.createDimension("t", None)
        raw.createDimension("s", 8)
        change(raw)
        for v in TABLE:
            if v.name not in raw.variables:
                raw.createVariable(v.name, v.dtype, v.dims)
        if not raw.dimensions["t"].size:
            raw.variables["t"][0] = 0.0


def text_for_area(raw):
    raw.createVariable("area", str, ("t",))


def compound_for_area(raw):
    pair = raw.createCompoundType(np.dtype([("a", "f8"), ("b", "f8")]), "pair")
    raw.createVariable("area", pair, ("t",))


def other_dims(raw):
    raw.createVariable("x", "f8", ("s", "t"))


def other_source(raw):
    raw.source = "someone"


def numeric_source(raw):
    raw.source = np.arange(3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (text_for_area, "missing or different area"),
        (compound_for_area, "missing or different area"),
        (other_dims, "missing or different x"),
        (other_source, "is not a result of rodloop run"),
        (numeric_source, "is not a result of rodloop run"),
    ],
)
def test_files_of_strangers(tmp_path, change, message):
    foreign(tmp_path / "a.nc", change)
    with pytest.raises(OutputError, match=message):
        open_run(tmp_path / "a.nc")


def test_declared_size_beyond_the_file_is_refused(tmp_path):
    def enormous(raw):
        raw.createVariable("t", "f8", ("t",), fill_value=False)
        raw.variables["t"][10**10] = 1.0

    foreign(tmp_path / "a.nc", enormous)
    with pytest.raises(OutputError, match="is damaged: it declares"):
        open_run(tmp_path / "a.nc")


def test_attributes_are_not_decoded(tmp_path):
    def confusing(raw):
        t = raw.createVariable("t", "f8", ("t",))
        t[:] = [1.0, 2.0]
        t.units, t.calendar, t.scale_factor = "days since yesterday", "none", 2.0

    foreign(tmp_path / "a.nc", confusing)
    with open_run(tmp_path / "a.nc") as run:
        assert run.t.values.tolist() == [1.0, 2.0]


def test_rows_that_were_not_sealed_are_dropped(tmp_path):
    def torn(raw):
        raw.createVariable("t", "f8", ("t",))[:] = [0.0, 0.1]
        raw.createVariable("x", "f8", ("t", "s"))[:] = np.zeros((4, 8))

    foreign(tmp_path / "a.nc", torn)
    with open_run(tmp_path / "a.nc") as run:
        assert run.t.values.tolist() == [0.0, 0.1]
