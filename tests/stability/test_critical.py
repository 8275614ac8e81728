"""Critical pressures: the paper's measure, its limit, and the loss of stability."""

import numpy as np
import pytest

from rodloop_cli.critical.curves import Grid, over_grid, two_segments
from rodloop_cli.critical.fourier import SineSeries, fourier_pressure
from rodloop_cli.critical.loads import Search, critical_loads
from rodloop_cli.critical.measure import compressibility, least_energy
from rodloop_cli.errors import ConvergenceError
from rodloop_cli.physics.rod import Rod, Segment
from rodloop_cli.plot.stability import fit_19
from rodloop_cli.stability.threshold import find_threshold
from rodloop_cli.stability.watch import Watched
from rodloop_cli.statics.branch import BranchPoint
from rodloop_cli.statics.loaded import at_zero_load


def pressure(ratio, k=0.5, alpha=0.9999, cells=12):
    return least_energy(at_zero_load(two_segments(ratio, k), cells), alpha).p


# -- p(α)


@pytest.mark.parametrize(("alpha", "paper"), [(0.95, 3.087), (0.99, 3.016), (0.999, 3.0016), (0.9999, 3.0001)])
def test_the_uniform_loop_has_the_digits_of_the_paper(alpha, paper):
    """The paper cuts digits off instead of rounding: 3.01698 is printed as 3.016."""
    digits = 3 if alpha < 0.999 else 4
    assert np.floor(pressure(1, alpha=alpha) * 10**digits) / 10**digits == pytest.approx(paper, abs=1e-12)


@pytest.mark.parametrize(("alpha", "expected"), [(0.999, 0.108526), (0.9999, 0.0111163), (0.99999, 0.00111435)])
def test_ratio_5(alpha, expected):
    assert pressure(5, alpha=alpha) == pytest.approx(expected, rel=1e-5)


def test_the_peak_of_fig_8():
    values = {ratio: pressure(ratio) for ratio in (1.01, 1.02, 1.03, 1.04, 1.05, 1.06)}
    assert values[1.04] == pytest.approx(3.025, abs=5e-4)
    assert max(values.values()) == pytest.approx(3.0255, abs=1e-4)


@pytest.mark.parametrize("k", [0.1, 0.3, 0.47, 0.49, 0.5])
@pytest.mark.parametrize("ratio", [1.02, 1.1, 2.0, 5.0])
def test_reciprocity(ratio, k):
    """Eq. (18)."""
    assert pressure(ratio, k) == pytest.approx(ratio * pressure(1 / ratio, 1 - k), rel=1e-8)


@pytest.mark.parametrize("ratio", [1.01, 1.02, 1.03, 1.05, 1.1])
def test_the_loop_found_is_a_minimum(ratio):
    loop = least_energy(at_zero_load(two_segments(ratio, 0.5), 12), 0.9999)
    assert Watched(BranchPoint.first(loop)).is_minimum


def test_the_curve_has_no_jumps():
    """In the region where a minimiser that is started anew jumps."""
    ratios = np.linspace(1.0, 1.12, 25)[1:]
    values = np.array([pressure(float(ratio)) for ratio in ratios])
    assert np.abs(np.diff(values, 2)).max() < 4e-3


def test_cells_do_not_matter():
    assert pressure(5, 0.3, cells=10) == pytest.approx(pressure(5, 0.3, cells=24), rel=1e-8)


def test_more_area_asks_for_a_negative_pressure():
    assert pressure(5, alpha=1.001) == pytest.approx(-0.114593, rel=1e-4)


@pytest.mark.parametrize(("ratio", "alpha"), [(1, 1.01), (5, 1.03), (5, 1.0)])
def test_an_area_that_no_loop_has_is_refused(ratio, alpha):
    with pytest.raises(ConvergenceError, match="no loop encloses"):
        pressure(ratio, alpha=alpha)


def test_the_fit_of_the_paper_peaks_at_three():
    assert fit_19(np.array([1.0]))[0] == pytest.approx(3.0)


# -- Appendix D


@pytest.mark.parametrize("alpha", [0.95, 0.99, 0.9999])
def test_the_sine_series_agrees_for_a_uniform_loop(alpha):
    assert fourier_pressure(Rod(), alpha, 20) == pytest.approx(pressure(1, alpha=alpha), rel=1e-6)


def test_the_sine_series_converges_like_one_over_its_modes():
    exact = pressure(5)
    errors = [fourier_pressure(two_segments(5, 0.5), 0.9999, modes) - exact for modes in (20, 40)]
    assert errors[0] / errors[1] == pytest.approx(2, abs=0.3)


def test_the_gradients_of_the_sine_series():
    loop = at_zero_load(two_segments(3.0, 0.4), 12)
    series = SineSeries(loop.equations.mesh, loop.equations.rule, 8)
    a = 0.1 * np.random.default_rng(0).normal(size=8)
    for function, slope in ((series.energy, series.energy_slope), (series.area, series.area_slope)):
        steps = [(function(a + 1e-6 * e) - function(a - 1e-6 * e)) / 2e-6 for e in np.eye(8)]
        assert slope(a) == pytest.approx(np.array(steps), abs=1e-8)


# -- the three side by side


def test_the_uniform_loop():
    loads = critical_loads(Rod(), Search())
    assert (loads.p_limit, loads.p_stability) == (pytest.approx(3, abs=1e-6), pytest.approx(3, abs=1e-8))
    assert loads.stability_kind == "bifurcation"


def test_ratio_5_never_loses_stability():
    loads = critical_loads(two_segments(5, 0.5), Search())
    assert loads.p_alpha == pytest.approx(0.0111163, rel=1e-5)
    assert (loads.p_limit, loads.p_stability, loads.p_searched) == (0.0, None, 10.0)
    assert loads.compressibility * loads.p_alpha == pytest.approx(1e-4, rel=1e-2)


def test_ratio_5_bifurcates_beyond_ten():
    threshold = find_threshold(at_zero_load(two_segments(5, 0.5), 12), 20.0).threshold
    assert (threshold.p, threshold.kind) == (pytest.approx(14.8323, abs=1e-3), "bifurcation")


def test_ratio_1_02_softens_at_three():
    loads = critical_loads(two_segments(1.02, 0.5), Search(p_max=4.5))
    assert (loads.p_soft, loads.p_stability) == (pytest.approx(3, abs=0.01), None)


@pytest.mark.parametrize(("ratio", "k"), [(0.3, 0.5), (1.3, 0.3), (5, 0.8)])
def test_thresholds_are_reciprocal_too(ratio, k):
    direct, mirrored = (
        find_threshold(at_zero_load(rod, 12), 60.0).threshold.p
        for rod in (two_segments(ratio, k), two_segments(1 / ratio, 1 - k))
    )
    assert direct == pytest.approx(ratio * mirrored, rel=1e-4)


@pytest.mark.parametrize("ratio", [1, 1.02, 5])
def test_inflation_is_stable(ratio):
    stability = find_threshold(at_zero_load(two_segments(ratio, 0.5), 12), -30.0)
    assert (stability.threshold, stability.p_contact) == (None, None)
    assert stability.p[-1] <= -30


def test_a_branch_may_end_in_self_contact():
    stability = find_threshold(at_zero_load(two_segments(0.3, 0.9), 12), 20.0, until_contact=True)
    assert stability.threshold is None
    assert stability.p_contact == pytest.approx(3.41242, abs=1e-3)


def test_any_number_of_segments():
    rod = Rod((Segment(0.2), Segment(0.3, 4.0), Segment(0.5, 2.0)))
    loads = critical_loads(rod, Search())
    assert 0 < loads.p_alpha < 1
    assert compressibility(at_zero_load(rod, 12)) > 1e-4


def test_a_grid_keeps_what_fails():
    outcomes = list(over_grid(Grid((1.01,), (1.0, 5.0), (0.5,)), Search(p_max=1.0), jobs=1))
    assert "no loop encloses" in outcomes[0]
    assert outcomes[1].p_alpha < 0
