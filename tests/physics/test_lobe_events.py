"""Lobes that are lost, on constructed curvatures and on the paper's case."""

import numpy as np
import pytest

from rodloop_cli import Case, simulate
from rodloop_cli.physics.lobe_events import Fate, LobeWatch, radial_range

POINTS = 240
S = np.arange(POINTS) * 2 * np.pi / POINTS


def bump(place: float, width: float = 0.25) -> np.ndarray:
    apart = np.angle(np.exp(1j * (S - place)))
    return np.exp(-((apart / width) ** 2))


def events_of(shapes):
    watch = LobeWatch()
    for time, curvature in enumerate(shapes):
        watch.watch(float(time), curvature)
    return list(watch.events())


def merging(share):
    """Two of four lobes move together."""
    return -1 + 4 * np.maximum(bump(1.2 + 0.35 * share), bump(1.9 - 0.35 * share)) + 4 * bump(3.8) + 4 * bump(5.5)


def sinking(share):
    """The middle one of three neighbours turns concave."""
    return -1 + 4 * (bump(1.0) + bump(3.0) + bump(5.0)) + (3 - 5 * share) * bump(2.0)


def test_two_lobes_that_merge_coalesce():
    (event,) = events_of(merging(share) for share in np.linspace(0, 1, 21))
    assert event.fate is Fate.COALESCENCE
    assert 1.2 < event.arclength < 1.9


def test_a_lobe_that_turns_concave_collapses():
    (event,) = events_of(sinking(share) for share in np.linspace(0, 1, 21))
    assert event.fate is Fate.COLLAPSE
    assert event.arclength == pytest.approx(2.0, abs=0.1)


def test_places_and_fates_do_not_depend_on_where_s_begins():
    for make in (merging, sinking):
        (event,) = events_of(make(share) for share in np.linspace(0, 1, 21))
        (turned,) = events_of(np.roll(make(share), 150) for share in np.linspace(0, 1, 21))
        assert turned.fate is event.fate
        assert turned.arclength == pytest.approx((event.arclength + 150 * 2 * np.pi / POINTS) % (2 * np.pi), abs=1e-9)


def test_a_lobe_that_comes_back_was_not_lost():
    shares = np.r_[np.linspace(0, 1, 21), np.linspace(1, 0, 21)]
    assert not events_of(sinking(share) for share in shares)


def test_lobes_that_cannot_be_seen_are_not_followed():
    assert not events_of(1 + 1e-3 * (sinking(share) + 1) for share in np.linspace(0, 1, 21))


@pytest.mark.parametrize("mode", [2, 5, 12])
def test_the_radial_range_of_a_mode_is_twice_its_amplitude(mode):
    assert radial_range(1 + 0.01 * (mode**2 - 1) * np.cos(mode * S)) == pytest.approx(0.02, rel=1e-2)


@pytest.mark.parametrize("amplitude", [5e-5, 5e-3])
def test_six_lobes_become_five_at_p_64(amplitude):
    wave = {"random": {"amplitude": amplitude, "modes": [2, 12], "seed": 2}}
    run = simulate(Case.model_validate({"p": 64, "t_end": 0.5, "perturbation": [wave]}))
    assert run.attrs["lobe_event_fates"] == "coalescence"
    (time,) = run.attrs["lobe_event_times"]
    assert (int(run["lobes"].sel(t=time, method="nearest")), int(run["lobes"][-1])) == (6, 5)


def test_a_soft_half_loses_its_middle_lobe_by_collapse():
    run = simulate(Case(p=32, stiffness_ratio=5, t_end=0.315))
    places = dict(zip(run.attrs["lobe_event_fates"].split(), run.attrs["lobe_event_arclengths"], strict=True))
    assert places["collapse"] == pytest.approx(np.pi / 2, abs=0.05)


def test_a_low_shoulder_that_sinks_collapses():
    def sinking_beside_a_taller_lobe(share):
        return -1 + 6 * (bump(1.0) + bump(3.3) + bump(5.0)) + (2.2 - 4 * share) * bump(1.75)

    (event,) = events_of(sinking_beside_a_taller_lobe(share) for share in np.linspace(0, 1, 21))
    assert event.fate is Fate.COLLAPSE
