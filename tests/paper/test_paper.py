"""The paper's cases, the table of figures, and the cache of results."""

import numpy as np
import pytest

from scripts.paper import measures, results
from scripts.paper.drawing import FIGURES, MOVIES, runs_of
from scripts.paper.homogeneous import growth_squared
from scripts.paper.markdown import compared, paragraph, table
from scripts.paper.stiffness import fitted

CASES = sorted(path.stem for path in results.CONFIGS.glob("*.yaml") if path.stem not in results.STATICS)


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setattr(results, "OUT", tmp_path)
    return tmp_path / "results"


@pytest.mark.parametrize("name", CASES)
def test_every_case_is_valid(name):
    assert results.case(name).title


@pytest.mark.parametrize("name", [*FIGURES, *MOVIES])
def test_every_figure_but_the_formula_of_fig_2_has_its_runs(name):
    known = {*CASES, *results.STATICS}
    runs = list(runs_of(name))
    assert set(runs) <= known
    assert bool(runs) is (name != "fig02")


def test_every_case_is_drawn():
    drawn = {run for name in (*FIGURES, *MOVIES) for run in runs_of(name)}
    assert set(CASES) - drawn == {"fig02"}


def test_an_unchanged_case_is_not_run_again(cache, monkeypatch):
    first = results.result("fig11f", "t_end=0.01", "snapshots=2")
    (file,) = cache.iterdir()
    monkeypatch.setattr(results, "simulate", None)
    assert results.result("fig11f", "t_end=0.01", "snapshots=2").equals(first)
    assert list(cache.iterdir()) == [file]


def test_another_case_and_another_program_are_run_anew(cache, monkeypatch):
    results.result("fig11f", "t_end=0.01", "snapshots=2")
    results.result("fig11f", "t_end=0.02", "snapshots=2")
    monkeypatch.setattr(results, "program", lambda: "another")
    results.result("fig11f", "t_end=0.01", "snapshots=2")
    assert len(list(cache.iterdir())) == 3


def test_the_fastest_modes_are_those_the_paper_names():
    p = np.array([3.8, 16.0, 32.0, 64.0, 128.0])
    rates = np.stack([growth_squared(n, p) for n in range(2, 12)])
    assert list(rates.argmax(axis=0) + 2) == [2, 3, 4, 6, 8]


def test_the_fit_obeys_reciprocity():
    assert fitted(np.array([3.0]))[0] == pytest.approx(3 * fitted(np.array([1 / 3]))[0])


def test_turning_points_of_a_cosine():
    t = np.linspace(0, 10, 201)
    assert measures.turning_points(t, np.cos(t)) == pytest.approx([np.pi, 2 * np.pi, 3 * np.pi], abs=1e-3)


def test_markdown():
    assert compared("a", 2, 2.5, "why") == "| a | 2 | 2.5 | +25 % | why |"
    assert list(table("a", "b")) == ["", "| a | b |", "| --- | --- |"]
    assert paragraph("\n    one\n    two\n  ") == "\none\ntwo"


@pytest.mark.slow
def test_the_paper_period_of_the_stiff_loop():
    assert results.result("fig09").attrs["period"] == pytest.approx(2.25, rel=5e-3)
