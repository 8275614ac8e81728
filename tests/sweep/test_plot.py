"""Drawings of sweep.nc."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from rodloop_cli.cli import main
from rodloop_cli.errors import OutputError
from rodloop_cli.plot.options import Options
from rodloop_cli.plot.sweep import draw_lines, draw_map, draw_phases, lines, open_summary, overview, shapes
from rodloop_cli.sweep import run_sweep

BASE = "p: 4, stiffness_ratio: 5"


@pytest.fixture
def swept(sweep_file, tmp_path):
    def run(grid, more=""):
        with ThreadPoolExecutor(1) as pool:
            return open_summary(run_sweep(sweep_file(grid, BASE, more), tmp_path / "out", executor=pool))

    return run


def test_one_axis_gives_lines_and_two_give_maps(swept):
    assert len(overview(swept("p: [4, 8, 16]", "output: scalars"), Options()).axes) >= 3
    titles = [ax.get_title() for ax in overview(swept("p: [4, 8]; k: [0.4, 0.5, 0.6]"), Options()).axes]
    assert titles[0] == "lobes at the end"


def test_lines_have_gaps_where_nothing_was_found(swept):
    dataset = swept("p: [4, 8, 16]", "output: scalars")
    ax = Figure().subplots()
    draw_lines(ax, dataset, "first_crossing_time")
    assert np.isnan(ax.lines[0].get_ydata()).all()
    assert ax.get_xscale() == "log"


def test_a_map_has_a_cell_for_each_member(swept):
    dataset = swept("p: [4, 8]; k: [0.4, 0.5, 0.6]", "output: scalars")
    left, right = Figure().subplots(1, 2)
    draw_map(left, dataset, "peak_kinetic_energy")
    draw_phases(right, dataset)
    assert left.collections[0].get_array().shape == right.collections[0].get_array().shape == (2, 3)
    assert left.get_xlim() == pytest.approx((0.35, 0.65))
    assert left.get_xscale() == "linear"


def test_texts_and_zipped_values_have_ticks(swept):
    figure = lines(swept("scheme: [radau]", "output: scalars\nzip: {p: [4, 8], k: [0.5, 0.4]}"), Options())
    assert [tick.get_text() for tick in figure.axes[0].get_xticklabels()] == ["4, 0.5", "8, 0.4"]


def test_shapes_are_drawn_for_members_with_files(swept, tmp_path):
    dataset = swept("p: [4, 8]")
    ax = shapes(dataset, Options()).axes[0]
    assert len(ax.lines) == 4  # two segments each
    (tmp_path / "out" / "p=4.nc").unlink()
    assert len(shapes(dataset, Options()).axes[0].lines) == 3


@pytest.mark.parametrize("kind", ["overview", "lines", "shapes"])
def test_the_command_draws(swept, tmp_path, kind):
    swept("p: [4, 8]; k: [0.4, 0.5]; gamma: [0.1, 0.2]", "output: scalars")
    target = tmp_path / f"{kind}.png"
    assert main(["plot", str(tmp_path / "out" / "sweep.nc"), "--kind", kind, "-o", str(target)]) == 0
    assert target.stat().st_size > 1000


def test_what_cannot_be_drawn_is_said(swept, tmp_path, capsys):
    swept("p: [4, 8]", "output: scalars")
    assert main(["plot", str(tmp_path / "out" / "sweep.nc"), "--kind", "phases"]) == 2
    assert capsys.readouterr().err.endswith("a map needs two axes with several points; try --kind lines\n")
    Path(tmp_path / "none.nc").write_text("x")
    with pytest.raises(OutputError, match="damaged"):
        open_summary(tmp_path / "none.nc")
