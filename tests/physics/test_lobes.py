import timeit

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rodloop_cli.physics.lobes import count_lobes, find_lobes

S = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
RIGHT = np.arange(200) < 100


def curvature_of(x, y):
    """Curvature of a closed curve given by finely sampled (x, y), at 200 points evenly spaced in arclength."""
    size = len(x)
    wave = 1j * np.fft.fftfreq(size, 1.0 / size)
    z = x + 1j * y
    dz, ddz = np.fft.ifft(wave * np.fft.fft(z)), np.fft.ifft(wave**2 * np.fft.fft(z))
    speed = np.abs(dz)
    kappa = (np.conj(dz) * ddz).imag / speed**3
    arclength = np.concatenate([[0.0], np.cumsum(speed)]) * 2.0 * np.pi / speed.sum()
    return np.interp(S, arclength[:-1], kappa * speed.mean(), period=2.0 * np.pi)


def radial(r):
    """Curvature of the closed curve with polar radius r(phi)."""
    phi = np.linspace(0.0, 2.0 * np.pi, 4000, endpoint=False)
    return curvature_of(r(phi) * np.cos(phi), r(phi) * np.sin(phi))


def elastic_lobes(n, depth):
    """A deep shape as buckling makes them: tangent angle s + depth sin(n s), closed for n >= 2."""
    return 1.0 + n * depth * np.cos(n * S)


def test_circle_has_none():
    assert count_lobes(np.ones(200)) == 0
    assert count_lobes(1.0 + 1e-9 * np.random.default_rng(1).standard_normal(200)) == 0


@pytest.mark.parametrize("n", range(2, 13))
@pytest.mark.parametrize("amplitude", [1e-6, 1e-3, 0.02])
def test_perturbed_circle_has_the_mode_number(n, amplitude):
    assert count_lobes(1.0 + amplitude * (n * n - 1) * np.cos(n * S - 0.4)) == n
    assert count_lobes(radial(lambda phi: 1.0 + amplitude * np.cos(n * phi - 0.4))) == n


@pytest.mark.parametrize("n", range(2, 13))
@pytest.mark.parametrize("depth", [0.3, 1.0, 1.9])
def test_deep_shapes(n, depth):
    assert count_lobes(elastic_lobes(n, depth)) == n


@pytest.mark.parametrize("n", [2, 3, 5, 8, 12])
@given(seed=st.integers(0, 10**6))
def test_noise_and_grid_ripple_change_nothing(n, seed):
    rng = np.random.default_rng(seed)
    kappa = 1.0 + 0.5 * np.cos(n * S - rng.uniform(0.0, 6.0))
    assert count_lobes(kappa + 0.01 * rng.uniform(-1.0, 1.0, 200)) == n
    assert count_lobes(kappa + 0.3 * (-1.0) ** np.arange(200)) == n
    assert count_lobes(kappa + 0.02 * np.cos(60.0 * S)) == n


@given(n=st.integers(2, 12), start=st.integers(0, 199), scale=st.floats(1e-3, 1e3))
def test_neither_the_starting_point_nor_the_sense_nor_the_size_matters(n, start, scale):
    kappa = scale * (1.0 + 0.1 * np.cos(n * S) + 0.03 * np.cos(S))
    assert count_lobes(np.roll(kappa, start)) == count_lobes(kappa[::-1]) == n


def cassini(b):
    """r^2 = cos 2 phi + sqrt(b^4 - sin^2 2 phi): a peanut for b between 1 and sqrt 2."""
    return radial(lambda phi: np.sqrt(np.cos(2.0 * phi) + np.sqrt(b**4 - np.sin(2.0 * phi) ** 2)))


def test_ellipse_and_peanuts():
    phi = np.linspace(0.0, 2.0 * np.pi, 4000, endpoint=False)
    assert count_lobes(curvature_of(2.0 * np.cos(phi), np.sin(phi))) == 2
    assert [count_lobes(cassini(b)) for b in (1.3, 1.1, 1.03)] == [2, 2, 2]


def test_a_dumbbell_with_square_ends_has_four_corners():
    phi = np.linspace(0.0, 2.0 * np.pi, 4000, endpoint=False)
    assert count_lobes(curvature_of(np.cos(phi), np.sin(phi) * (0.3 + 0.7 * np.cos(phi) ** 2))) == 4


def test_egg_has_one():
    assert count_lobes(1.0 + 0.5 * np.cos(S)) == 1


def test_unequal_lobes_count_while_they_stand_out():
    def unequal(small):
        return sum(h * np.exp(-(((S - c) / 0.3) ** 2)) for c, h in ((1.0, small), (3.0, 1.0), (5.0, 1.0)))

    assert [count_lobes(unequal(small)) for small in (1.0, 0.5, 0.1)] == [3, 3, 3]
    assert count_lobes(unequal(0.03)) == 2


def test_merging_lobes_become_one_once():
    """Coalescence: two crests at distance d; the valley between them rises and vanishes."""

    def crest(centre):
        return np.exp(-(((S - centre) / 0.3) ** 2))

    counts = [count_lobes(crest(2.0 - d) + crest(2.0 + d) + crest(5.0)) for d in np.linspace(0.8, 0.0, 60)]
    assert counts[0] == 3
    assert counts[-1] == 2
    assert np.all(np.diff(counts) <= 0)


def test_a_lobe_that_turns_concave_is_lost():
    """Collapse: the middle one of three crests sinks below zero curvature."""

    def middle(height):
        return -0.5 + sum(h * np.exp(-(((S - c) / 0.3) ** 2)) for c, h in ((2.0, 2.0), (3.0, height), (4.0, 2.0)))

    assert [count_lobes(middle(height)) for height in (2.0, 1.0, 0.7)] == [3, 3, 3]
    assert [count_lobes(middle(height)) for height in (0.4, 0.2)] == [2, 2]


def test_jumps_at_junctions_add_no_lobe():
    stiffness = np.where(RIGHT, 1.0, 5.0)
    assert count_lobes(np.where(RIGHT, 1.6, 0.4)) == 1
    moment = 1.0 + 0.6 * np.cos(6.0 * S)
    assert count_lobes(moment / stiffness) == 6
    assert count_lobes(moment / np.roll(stiffness, 37)) in (6, 7)  # a crest cut by a junction may be two


def test_tops_are_where_the_crests_are():
    np.testing.assert_array_equal(find_lobes(1.0 + 0.1 * np.cos(4.0 * S)), [0, 50, 100, 150])
    assert find_lobes(np.ones(50)).shape == (0,)


def test_plateaus():
    kappa = np.tile(np.repeat([1.0, 2.0], 10), 5)
    assert count_lobes(kappa) == 5


def test_it_is_cheap():
    kappa = 1.0 + 0.3 * np.cos(8.0 * S)
    assert min(timeit.repeat(lambda: count_lobes(kappa), number=50, repeat=5)) / 50 < 5e-4
