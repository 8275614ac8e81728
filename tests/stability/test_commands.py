"""``rodloop critical`` and ``rodloop modes``, their files, and the drawings of these."""

import json

import numpy as np
import pytest
import xarray as xr

from rodloop_cli.cli import main
from rodloop_cli.dataset.stability_files import open_table
from rodloop_cli.errors import OutputError

CASE = "p: 3.8\nt_end: 1\nstiffness_ratio: 5\n"
CIRCLE = "p: 16\nt_end: 1\ndensity_ratio: 5\nzeta_perp: 0.5\n"


@pytest.fixture
def case_file(tmp_path):
    path = tmp_path / "case.yaml"
    path.write_text(CASE)
    return path


@pytest.fixture
def circle_file(tmp_path):
    path = tmp_path / "circle.yaml"
    path.write_text(CIRCLE)
    return path


def shown(capsys):
    return capsys.readouterr().out


def well_described(dataset):
    return all({"long_name", "units"} <= set(variable.attrs) for variable in dataset.variables.values())


# -- critical


def test_critical_of_one_rod_as_json(capsys):
    assert main(["critical", "--stiffness-ratio", "5", "-k", "0.5", "--alpha", "0.9999", "--json"]) == 0
    found = json.loads(shown(capsys))
    assert found["p_alpha"] == pytest.approx(0.0111163, rel=1e-5)
    assert (found["p_limit"], found["p_stability"]) == (0.0, None)


def test_critical_side_by_side_with_a_sentence(capsys):
    assert main(["critical"]) == 0
    lines = shown(capsys).splitlines()
    starts = ["p_alpha      3.000169", "p_limit      3 ", "p_stability  3   bifurcation", "p_soft       2.97 "]
    assert all(line.startswith(start) for line, start in zip(lines, starts, strict=False))
    assert lines[-1].endswith("whatever p_alpha is.")


def test_critical_of_a_case_by_the_sine_series(case_file, capsys):
    assert main(["critical", str(case_file), "--method", "fourier", "-M", "20", "--json", "--p-max", "2"]) == 0
    assert json.loads(shown(capsys))["p_alpha"] == pytest.approx(0.0127, abs=1e-4)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--stiffness-ratio", "0", "-k", "2"], "k: must be between 0 and 1 (got 2.0)"),
        (["-k", "x"], "must be a number, a list A,B,C or a range A:B:N (got x)"),
        (["--alpha", "1"], "alpha: must be positive and not 1 (got 1.0)"),
        (["--p-max", "0"], "between -1000 and 1000, and not 0"),
        (["--p-max", "nan"], "between -1000 and 1000, and not 0"),
        (["--p-max", "-5000"], "between -1000 and 1000, and not 0"),
        (["--density-ratio", "0"], "must be positive"),
        (["none.yaml"], "none.yaml: cannot be read"),
    ],
)
def test_critical_refuses(arguments, words, capsys):
    assert main(["critical", *arguments]) == 2
    assert words in capsys.readouterr().err


def test_critical_wants_one_source_of_the_rod(case_file, capsys):
    assert main(["critical", str(case_file), "-k", "0.3"]) == 2
    assert "gives the rod already; leave out -k" in capsys.readouterr().err


def test_critical_without_an_equilibrium_says_so(capsys):
    assert main(["critical", "--alpha", "1.5"]) == 3
    assert "no loop encloses 1.5 times the area" in capsys.readouterr().err


def test_a_grid_file_to_netcdf_and_to_a_figure(tmp_path, capsys):
    grid, out = tmp_path / "grid.yaml", tmp_path / "curves.nc"
    grid.write_text("base: none.yaml\ngrid:\n  stiffness_ratio: {linspace: [0.8, 1.25, 2]}\n  k: [0.47, 0.53]\n")
    assert main(["critical", str(grid), "--p-max", "1", "-o", str(out), "-j", "1"]) == 0
    assert shown(capsys) == f"{out}\n"
    dataset = open_table(out)
    assert dict(dataset.sizes) == {"alpha": 1, "stiffness_ratio": 2, "k": 2}
    p = dataset["p_alpha"].isel(alpha=0)
    assert float(p[1, 1]) == pytest.approx(1.25 * float(p[0, 0]), rel=1e-8)
    assert well_described(dataset)
    assert bool(np.isnan(dataset["p_stability"]).all())
    assert main(["critical", str(grid), "-o", str(out)]) == 2
    for kind in ("overview", "maps"):
        figure = tmp_path / f"{kind}.png"
        assert main(["plot", str(out), "--kind", kind, "-o", str(figure)]) == 0
        assert figure.stat().st_size > 10_000


def test_a_grid_file_with_mistakes(tmp_path, capsys):
    grid = tmp_path / "grid.yaml"
    grid.write_text("grid:\n  p: [1, 2]\n  k: [a]\n")
    assert main(["critical", str(grid)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 2


def test_a_grid_in_options_as_a_table(capsys):
    assert main(["critical", "--stiffness-ratio", "2,5", "--p-max", "1", "-j", "1"]) == 0
    lines = shown(capsys).splitlines()
    assert len(lines) == 3
    assert lines[2].split()[-1] == "none"


def test_a_grid_with_failures_keeps_the_rest(tmp_path, capsys):
    out = tmp_path / "some.nc"
    arguments = ["--stiffness-ratio", "1,5", "--alpha", "1.01", "--p-max", "1", "-j", "1", "-o", str(out)]
    assert main(["critical", *arguments]) == 3
    assert "1 of 2 rods could not be computed" in capsys.readouterr().err
    found = open_table(out)["p_alpha"].to_numpy().ravel()
    assert np.isfinite(found).tolist() == [False, True]


# -- modes


def test_modes_as_json(circle_file, capsys):
    assert main(["modes", str(circle_file), "--json", "--set", "zeta_perp=0"]) == 0
    found = json.loads(shown(capsys))
    rates = np.array(found["eigenvalues"])
    assert rates.shape == (24, 2)
    assert rates[:6, 0] ** 2 == pytest.approx([39.9411, 36.6968, 12.7550, 10.0605, 4.5779, 4.5199], abs=1e-4)
    assert not rates[:6, 1].any()
    assert found["lobes"] == 3


def test_modes_in_words(case_file, circle_file, capsys):
    assert main(["modes", str(case_file), "-n", "3"]) == 0
    assert shown(capsys).startswith("p = 3.8: no motion grows: the base state is stable\n mode ")
    assert main(["modes", str(circle_file), "-n", "3"]) == 0
    assert "the fastest growing mode has 3 lobes" in shown(capsys)


@pytest.mark.parametrize("name", ["case", "circle"])
def test_modes_to_netcdf_and_to_a_figure(name, case_file, circle_file, tmp_path, capsys):
    case, out = {"case": case_file, "circle": circle_file}[name], tmp_path / "modes.nc"
    assert main(["modes", str(case), "-n", "9", "-o", str(out)]) == 0
    dataset = open_table(out)
    assert dict(dataset.sizes) == {"p": 1, "mode": 9, "s": 200}
    assert well_described(dataset)
    assert dataset.attrs["Conventions"] == "CF-1.11"
    largest = np.hypot(dataset["displacement_x"], dataset["displacement_y"]).max("s")
    assert float(largest.max()) == pytest.approx(1, abs=1e-6)
    assert main(["plot", str(out), "-o", str(tmp_path / "modes.svg")]) == 0


def test_modes_over_a_range_of_pressures(case_file, tmp_path, capsys):
    out = tmp_path / "range.nc"
    assert main(["modes", str(case_file), "-n", "4", "--p", "0:4:3", "-o", str(out), "--json"]) == 0
    assert [at["p"] for at in json.loads(shown(capsys))["loads"]] == [0, 2, 4]
    assert main(["plot", str(out), "-o", str(tmp_path / "range.png")]) == 0


def test_a_base_state_that_is_not_reached_is_said(tmp_path, capsys):
    path = tmp_path / "case.yaml"
    path.write_text("p: 300\nt_end: 1\nstiffness_ratio: 5\n")
    assert main(["modes", str(path)]) == 3
    assert "turn back at p = 20.97" in capsys.readouterr().err


def test_a_foreign_file_is_refused(tmp_path):
    path = tmp_path / "foreign.nc"
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(path)
    with pytest.raises(OutputError, match="not a result of this version"):
        open_table(path)
