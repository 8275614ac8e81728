import timeit

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from rodloop_cli.physics.clearance import crossing_indicator, least_clearance
from rodloop_cli.physics.crossing import crosses_itself, find_crossings, star_shaped


def around(size=200, offset=0.37):
    return (np.arange(size) + offset) * 2.0 * np.pi / size


def circle(size=200):
    return np.sin(around(size)), -np.cos(around(size))


def peanut(neck, size=200):
    """Opposite sides meet in the middle of the loop as the neck's width goes through zero."""
    a = around(size)
    return np.cos(a), 0.5 * np.sin(a) * (neck + (1.0 - neck) * np.cos(a) ** 2)


def horseshoe(gap, size=200):
    """Two lobes meet from outside as the gap goes through zero: a thick arc that is bent into a ring."""
    a = around(size, 0.2)
    angle, radius = (np.pi - 0.5 * gap) * np.cos(a), 1.0 + 0.25 * np.sin(a)
    return radius * np.sin(angle), radius * np.cos(angle)


def lemniscate(size=200):
    return np.sin(around(size)), np.sin(2.0 * around(size))


def brute_force(x, y):
    """Every pair of edges that are not neighbours, in exact arithmetic."""
    from fractions import Fraction

    p = [(Fraction(float(a)), Fraction(float(b))) for a, b in zip(x, y, strict=True)]
    n = len(p)
    edges = [(p[i], p[(i + 1) % n]) for i in range(n)]
    return any(meet(*edges[i], *edges[j]) for i in range(n) for j in range(i + 2, n) if not (i == 0 and j == n - 1))


def side(a, b, c):
    cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (cross > 0) - (cross < 0)


def within(a, b, c):
    return min(a[0], b[0]) <= c[0] <= max(a[0], b[0]) and min(a[1], b[1]) <= c[1] <= max(a[1], b[1])


def meet(a, b, c, d):
    s = side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)
    if s[0] * s[1] < 0 and s[2] * s[3] < 0:
        return True
    touching = zip(s, ((a, b, c), (a, b, d), (c, d, a), (c, d, b)), strict=True)
    return any(k == 0 and within(*points) for k, points in touching)


def test_convex_and_near_touching_shapes_are_simple():
    a = around()
    for height in (1.0, 0.1, 1e-3, 1e-9):
        assert not crosses_itself(np.cos(a), height * np.sin(a))
        assert crossing_indicator(np.cos(a), height * np.sin(a)) > 0.0


@pytest.mark.parametrize("shape", [peanut, horseshoe])
@pytest.mark.parametrize("width", [0.3, 0.05, 5e-3, -5e-3, -0.05, -0.2])
def test_meeting_in_the_middle_and_from_outside(shape, width):
    x, y = shape(width)
    assert crosses_itself(x, y) == (width < 0.0)
    assert (crossing_indicator(x, y) <= 0.0) == (width < 0.0)
    assert len(find_crossings(x, y)) == (2 if width < 0.0 else 0)


@pytest.mark.parametrize("shape", [peanut, horseshoe])
def test_the_indicator_is_continuous_and_falls_through_contact(shape):
    widths = np.linspace(0.03, -0.03, 121)
    values = [crossing_indicator(*shape(w)) for w in widths]
    steps = np.diff(values)
    assert np.all(steps < 1e-6)
    assert np.abs(steps).max() < 3.0 * (widths[0] - widths[1])


@pytest.mark.parametrize("shape", [peanut, horseshoe])
def test_a_root_finder_gets_the_contact_in_few_steps(shape):
    calls = []

    def indicator(w):
        calls.append(w)
        return crossing_indicator(*shape(w))

    contact = brentq(indicator, 0.1, -0.1, xtol=1e-8)
    assert abs(contact) < 1e-3  # the polyline's own error, curvature x spacing^2 / 8
    assert not crosses_itself(*shape(contact + 1e-6))
    assert crosses_itself(*shape(contact - 1e-6))
    assert len(calls) <= 20


@pytest.mark.parametrize("size", [50, 100, 200, 400])
def test_the_contact_is_as_accurate_as_chords_are(size):
    contact = brentq(lambda width: crossing_indicator(*peanut(width, size)), 0.1, -0.1, xtol=1e-10)
    assert abs(contact) < 10.0 / size**2


@pytest.mark.parametrize("shape", [peanut, horseshoe])
@pytest.mark.parametrize("size", [40, 128, 400])
def test_the_bound_of_the_clearance_is_below_it_and_close(shape, size):
    for width in (0.4, 0.1, 0.02):
        x, y = shape(width, size)
        bound, clearance = least_clearance(x, y), crossing_indicator(x, y)
        assert bound <= clearance
        assert bound > 0.9 * clearance or clearance < 2 * np.hypot(np.diff(x), np.diff(y)).max()


def test_depth_of_a_known_overlap():
    x, y = peanut(-0.1, 2000)
    assert crossing_indicator(x, y) == pytest.approx(-0.1, rel=1e-3)
    x, y = peanut(0.1, 2000)
    assert crossing_indicator(x, y) == pytest.approx(0.1, rel=1e-3)


def test_figure_of_eight():
    x, y = lemniscate()
    assert crosses_itself(x, y)
    np.testing.assert_allclose(find_crossings(x, y), [[99.63, 199.63]], atol=0.01)
    assert crossing_indicator(x, y) < -1.0


@pytest.mark.parametrize("shape", [peanut, horseshoe])
@pytest.mark.parametrize("width", [0.9, 0.3, 0.05, 5e-3, -5e-3, -0.2])
def test_what_is_seen_whole_from_its_centre_does_not_cross(shape, width):
    x, y = shape(width)
    if star_shaped(np.array([x + 3.0, y - 1.0])):
        assert not crosses_itself(x, y)


def test_several_loops_are_seen_from_their_own_centres_at_once():
    loops = np.array([circle(), peanut(0.9), horseshoe(0.3), lemniscate()]).transpose(1, 0, 2)
    apart = loops + np.array([[0.0, 5.0, -3.0, 2.0], [1.0, 0.0, 4.0, -6.0]])[..., None]
    assert star_shaped(apart).tolist() == [True, True, False, False]


def test_twice_around_is_no_convex_curve():
    """Turns left everywhere, but twice around: the short cut for convex shapes must not be taken."""
    a = 2.0 * around(201)
    r = 1.0 + 0.3 * np.cos(around(201))
    assert crosses_itself(r * np.cos(a), r * np.sin(a))


def test_touching_counts():
    x = np.array([0.0, 2.0, 2.0, 1.0, 0.0])
    y = np.array([0.0, 0.0, 1.0, 0.0, 1.0])
    assert crosses_itself(x, y)
    assert crossing_indicator(x, y) <= 0.0
    y[3] = 1e-12
    assert not crosses_itself(x, y)


def test_overlapping_edges_on_one_line():
    x = np.array([0.0, 3.0, 3.0, 2.0, 2.0, 1.0, 1.0, 0.0])
    y = np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0])
    assert crosses_itself(x, y)
    assert crossing_indicator(x, y) <= 0.0


@pytest.mark.parametrize("shape", [circle, peanut, horseshoe])
@given(seed=st.integers(0, 10**6), size=st.floats(-12.0, -1.0))
@settings(max_examples=25, deadline=None)
def test_random_perturbations_agree_with_brute_force(shape, seed, size):
    rng = np.random.default_rng(seed)
    x, y = shape(40) if shape is circle else shape(float(rng.uniform(-0.1, 0.1)), 40)
    x, y = x + 10.0**size * rng.standard_normal(40), y + 10.0**size * rng.standard_normal(40)
    expected = brute_force(x, y)
    assert crosses_itself(x, y) == expected
    assert (crossing_indicator(x, y) <= 0.0) == expected


@given(st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), min_size=4, max_size=12, unique=True))
@settings(max_examples=200, deadline=None)
def test_polygons_on_a_grid_agree_with_brute_force(points):
    """Small integers: vertices on edges, edges on one line, and exact arithmetic on both sides."""
    x, y = np.array(points, dtype=float).T
    assert crosses_itself(x, y) == brute_force(x, y)


@given(seed=st.integers(0, 10**6), start=st.integers(0, 59), angle=st.floats(0.0, 6.3))
@settings(max_examples=40, deadline=None)
def test_neither_start_nor_sense_nor_orientation_matters(seed, start, angle):
    rng = np.random.default_rng(seed)
    x, y = peanut(float(rng.uniform(-0.2, 0.2)), 60)
    turned = np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y
    value = crossing_indicator(x, y)
    assert crossing_indicator(*turned) == pytest.approx(value, abs=1e-9)
    assert crossing_indicator(np.roll(x, start), np.roll(y, start)) == pytest.approx(value, abs=1e-9)
    assert crossing_indicator(x[::-1], y[::-1]) == pytest.approx(value, abs=1e-9)


def test_it_is_cheap():
    x, y = peanut(0.2)
    assert min(timeit.repeat(lambda: crosses_itself(x, y), number=20, repeat=5)) / 20 < 1e-3
    assert min(timeit.repeat(lambda: crossing_indicator(x, y), number=5, repeat=5)) / 5 < 5e-3
