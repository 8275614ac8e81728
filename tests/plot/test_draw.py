"""What is on the axes."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle

from rodloop_cli.case import parse_case
from rodloop_cli.errors import OutputError
from rodloop_cli.plot import (
    draw_curvature,
    draw_displacement,
    draw_dissipation,
    draw_energies,
    draw_forces,
    draw_kymograph,
    draw_shapes,
    overview,
    style,
)
from rodloop_cli.plot.displacement import transverse
from rodloop_cli.plot.frames import crossing_time, last_sound, nearest, sound, spread
from rodloop_cli.plot.heading import trouble_of
from rodloop_cli.plot.look import AFTER_CROSSING, NOT_PHYSICAL
from rodloop_cli.plot.options import Options
from rodloop_cli.plot.segments import BLUE, GREEN, ORANGE, PINK, PURPLE, SKY, materials, name, segments

IN_TIME = [draw_energies, draw_displacement, draw_dissipation]


@pytest.fixture
def ax():
    with style():
        yield Figure(layout="constrained").add_subplot()


def drawn(ax):
    """Draws for real, so that warnings come out."""
    ax.figure.draw_without_rendering()
    return ax


def replaced(dataset, **profiles):
    return dataset.assign({name: (("t", "s"), values) for name, values in profiles.items()})


def legend_of(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def test_shapes_have_equal_aspect_and_a_colour_for_each_segment(ax, damped, crossing):
    draw_shapes(ax, crossing, [0])
    assert drawn(ax).get_aspect() == 1
    assert [line.get_color() for line in ax.lines[:2]] == [ORANGE, BLUE]
    assert legend_of(ax) == ["segment 1", "segment 2: $B_{2}/B_1 = 5$", "$s = 0$"]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$x/R$", "$y/R$")


def test_the_pieces_of_a_shape_close_the_loop(ax, crossing):
    draw_shapes(ax, crossing, [3])
    first, second, dot = (line.get_xydata() for line in ax.lines[:3])
    assert np.array_equal(first[-1], second[0])
    assert np.array_equal(second[-1], first[0])
    assert np.array_equal(dot[0], first[0])


def test_shapes_beside_each_other(ax, crossing):
    draw_shapes(ax, crossing, [0, 0], spacing=3)
    assert np.allclose(ax.lines[3].get_xdata() - ax.lines[0].get_xdata(), 3)


def test_shapes_after_a_crossing_are_grey_and_dashed_and_the_legend_says_so(ax, crossing):
    frames = spread(crossing, 6)
    draw_shapes(ax, crossing, frames)
    physical = np.repeat(sound(crossing)[frames], 3)
    assert not physical.all()
    for line, is_physical in zip(ax.lines, physical, strict=True):
        assert (line.get_color() == AFTER_CROSSING) != is_physical
        assert line.get_linestyle() in ({"-", "None"} if is_physical else {"--", "None"})
    assert NOT_PHYSICAL in legend_of(drawn(ax))


@pytest.mark.parametrize("draw", [*IN_TIME, draw_kymograph])
def test_times_after_a_crossing_are_hatched(ax, crossing, draw):
    draw(ax, crossing)
    hatched = [p for p in ax.patches if isinstance(p, (Polygon, Rectangle)) and p.get_hatch()]
    assert [p.get_extents().x0 for p in hatched] == pytest.approx(
        [ax.transData.transform((crossing_time(crossing), 0))[0]], abs=1
    )
    assert any(NOT_PHYSICAL in text.get_text() for text in drawn(ax).texts)


@pytest.mark.parametrize("draw", [*IN_TIME, draw_kymograph])
def test_without_a_crossing_nothing_is_hatched(ax, damped, draw):
    draw(ax, damped)
    assert not [p for p in drawn(ax).patches if p.get_hatch()]


@pytest.mark.parametrize("draw", IN_TIME)
def test_lines_over_time_are_dashed_after_a_crossing(ax, crossing, draw):
    draw(ax, crossing)
    dashed = [line for line in ax.lines if line.get_linestyle() == "--"]
    assert dashed
    assert all(line.get_xdata()[1] > crossing_time(crossing) for line in dashed)


def test_profiles_after_a_crossing_say_so(ax, crossing):
    draw_curvature(ax, crossing, [13])
    assert "not physical" in drawn(ax).get_title(loc="left")
    assert ax.lines[0].get_color() == AFTER_CROSSING


def test_forces_are_those_of_the_last_physical_frame(ax, crossing):
    draw_forces(ax, crossing, "axial")
    assert ax.lines[0].get_ydata()[0] == crossing["axial_force"][last_sound(crossing), 0]
    assert "F_t R^2/B_1" in drawn(ax).get_ylabel()


def test_curvature_is_not_joined_where_it_jumps(ax, crossing, damped):
    draw_curvature(ax, crossing)
    assert sum(len(line.get_xdata()) for line in ax.lines[:2]) == crossing.sizes["s"]


def test_energies_begin_at_zero_and_tell_the_residual(ax, damped):
    draw_energies(ax, damped)
    assert [line.get_ydata()[0] for line in ax.lines] == [0, 0, 0, 0, 0]
    assert legend_of(drawn(ax))[:4] == [r"$\Delta E_b$", r"$\Delta E_t$", "$E_k$", "$E_d$"]
    assert r"|\Sigma|" in legend_of(ax)[4]


def test_without_drag_no_dissipated_energy_is_drawn(ax, crossing):
    draw_energies(ax, crossing)
    assert "$E_d$" not in legend_of(ax)


@pytest.mark.parametrize(("start", "end"), [(0, np.pi), (np.pi, 2 * np.pi), (1, 3)])
def test_displacement_of_a_circle_is_the_height_of_its_arc(crossing, start, end):
    s = crossing["s"].to_numpy()
    circle = replaced(crossing, x=np.tile(np.sin(s), (14, 1)), y=np.tile(-np.cos(s), (14, 1)))
    assert transverse(circle, start, end) == pytest.approx(np.full(14, 1 - np.cos((end - start) / 2)), abs=5e-3)


def test_every_axis_of_the_overview_is_labelled(crossing):
    with style():
        figure = overview(crossing, Options())
        figure.draw_without_rendering()
    shapes, *others = figure.axes[:5]
    assert all(ax.get_xlabel() and ax.get_ylabel() for ax in [shapes, *others])
    assert figure.get_suptitle() == "Past the crossing"
    assert "crosses itself after t = 0.4" in figure.get_supxlabel()


# -- frames


def test_frames_are_physical_up_to_the_located_crossing(crossing):
    t, limit = crossing["t"].to_numpy(), crossing.attrs["first_crossing_time"]
    assert np.array_equal(sound(crossing), t <= limit)


def test_a_frame_at_the_crossing_itself_is_physical(crossing):
    crossing.attrs["first_crossing_time"] = float(crossing["t"][9])
    crossing["crossing"] = "t", np.arange(14) >= 9
    assert last_sound(crossing) == 9


def test_a_crossing_between_frames_that_is_over_in_the_next_counts(crossing):
    crossing["crossing"] = "t", np.zeros(14, dtype="i1")
    crossing.attrs["first_crossing_time"] = 0.3
    assert np.array_equal(sound(crossing), crossing["t"].to_numpy() <= 0.3)


@pytest.mark.parametrize("attribute", [None, np.nan, 1e9, "soon"])
def test_without_a_located_crossing_the_flags_decide(crossing, attribute):
    crossing.attrs["first_crossing_time"] = attribute
    crossing["crossing"] = "t", np.isin(np.arange(14), [4, 5])
    assert np.array_equal(np.flatnonzero(sound(crossing)), [0, 1, 2, 3])


def test_a_run_that_begins_crossed_has_no_physical_frame(crossing):
    del crossing.attrs["first_crossing_time"]
    crossing["crossing"] = "t", np.ones(14, dtype="i1")
    assert not sound(crossing).any()
    with style():
        overview(crossing, Options()).draw_without_rendering()


def test_nearest_frames(crossing):
    assert nearest(crossing, [0.7, -1, 0.054, 0.055, 1e9]) == [0, 1, 13]


def test_frames_follow_the_motion(damped):
    x = np.concatenate([np.zeros((7, 48)), np.arange(7)[:, None] * np.ones(48)])
    moving = replaced(damped, x=x, y=np.zeros((14, 48)))
    assert spread(moving, 4)[1:] == [9, 11, 13]


def test_one_frame_can_be_drawn_but_not_mapped(damped, ax):
    one = damped.isel(t=[0])
    with style():
        overview(one, Options()).draw_without_rendering()
    with pytest.raises(OutputError, match="one stored time is no map"):
        draw_kymograph(ax, one)


# -- segments


@pytest.mark.parametrize(
    ("ratios", "colour", "label"),
    [
        ("stiffness_ratio: 5", BLUE, "segment 2: $B_{2}/B_1 = 5$"),
        ("stiffness_ratio: 0.2", SKY, "segment 2: $B_{2}/B_1 = 0.2$"),
        ("density_ratio: 5", PURPLE, r"segment 2: $\rho_{2}/\rho_1 = 5$"),
        ("density_ratio: 0.2", PINK, r"segment 2: $\rho_{2}/\rho_1 = 0.2$"),
        ("stiffness_ratio: 2\ndensity_ratio: 5", GREEN, r"segment 2: $B_{2}/B_1 = 2$, $\rho_{2}/\rho_1 = 5$"),
    ],
)
def test_colours_tell_materials(crossing, ratios, colour, label):
    crossing.attrs["case"] = parse_case(f"p: 1\nt_end: 1\n{ratios}").to_yaml()
    grouped = materials(crossing)
    assert list(grouped) == [ORANGE, colour]
    assert name(grouped[colour]) == label


def test_segments_of_one_material_share_a_colour(crossing):
    parts = "[{fraction: 0.2}, {fraction: 0.3, stiffness: 2}, {fraction: 0.1}, {fraction: 0.4, stiffness: 3}]"
    crossing.attrs["case"] = parse_case(f"p: 1\nt_end: 1\nsegments: {parts}").to_yaml()
    grouped = materials(crossing)
    assert [len(members) for members in grouped.values()] == [2, 1, 1]
    assert name(grouped[ORANGE]) == "segments 1, 3"
    assert segments(crossing)[2].start == pytest.approx(np.pi)


def test_without_a_readable_case_the_points_tell_the_segments(crossing, caplog):
    crossing.attrs["case"] = "p: [oh"
    first, second = segments(crossing)
    assert first.end == second.start == pytest.approx(np.pi)
    assert second.end == pytest.approx(2 * np.pi)
    assert "without their materials" in caplog.text


def test_time_runs_from_light_to_dark(crossing):
    shades = segments(crossing)[0].shades(np.linspace(0, 1, 5)).sum(axis=1)
    assert (np.diff(shades) < 0).all()


# -- title


@pytest.mark.parametrize(
    ("outcome", "title"),
    [
        ("reached t_end", ""),
        ("stopped at first crossing, t = 0.5", ""),
        ("settled at an equilibrium, t = 1", ""),
        (None, "UNFINISHED RUN: rows up to t = 0.7"),
        ("no convergence", "FAILED RUN, rows up to t = 0.7: no convergence"),
    ],
)
def test_the_title_tells_what_went_wrong(crossing, outcome, title):
    del crossing.attrs["outcome"]
    if outcome:
        crossing.attrs["outcome"] = outcome
    assert trouble_of(crossing) == title
