"""What `tol` is measured against: the size of the motion, as long as that is below one radius."""

import numpy as np
import pytest

from rodloop_cli import Case, simulate

WAVE = [{"mode": 2, "amplitude": 5e-3}]


def position_error(tol, **values):
    """Largest distance between stored positions of a run and of one at a hundredth of its tolerance."""
    run, finer = (simulate(Case(**values, tol=t, snapshots=11, output_points=32)) for t in (tol, tol / 100))
    return float(np.hypot(run.x - finer.x, run.y - finer.y).max())


@pytest.mark.parametrize("p", [1.0, -1.0])
def test_swings_of_a_light_half_are_followed_as_small_as_they_are(p):
    """Its accelerations are a thousand times those of the heavy half, and lead nowhere: 5 tol when they counted."""
    assert position_error(1e-4, p=p, density_ratio=0.001, perturbation=WAVE, t_end=1.0) < 5e-5


def test_a_loop_that_leaves_the_circle_is_followed_from_the_start():
    assert position_error(1e-3, p=16.0, perturbation=[{"mode": 3, "amplitude": 1e-5}], t_end=1.0) < 1e-6


def test_a_pushed_loop_needs_no_perturbation():
    assert position_error(1e-3, p=5.0, stiffness_ratio=3.0, t_end=1.0) < 1e-3
