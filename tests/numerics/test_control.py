"""Step sizes and roots: the properties that the time loop relies on."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rodloop_cli.numerics.control import (
    LARGEST_CUT,
    LARGEST_GROWTH,
    SAFETY,
    WORTH_CHANGING,
    Controller,
    settle_on,
)
from rodloop_cli.numerics.roots import MOST_EVALUATIONS, bracketed_root, root_between

ERRORS = st.floats(1e-12, 1e12)
SIZES = st.floats(1e-6, 1e2)


@given(error=ERRORS, last_error=ERRORS, size=SIZES, last_size=SIZES, exponent=st.integers(2, 8))
def test_steps_change_within_bounds_and_shrink_after_a_rejection(error, last_error, size, last_size, exponent):
    factor = Controller(exponent, last_size, last_error).factor(size, error)
    assert LARGEST_CUT <= factor <= LARGEST_GROWTH
    if error > 1:
        assert factor < 1


@given(error=ERRORS, size=SIZES, exponent=st.integers(2, 8))
def test_a_larger_error_never_asks_for_a_longer_step(error, size, exponent):
    controller = Controller(exponent)
    assert controller.factor(size, 2 * error) <= controller.factor(size, error)


def test_a_first_step_with_the_allowed_error_is_kept_but_for_safety():
    assert Controller(4).factor(0.1, 1.0) == pytest.approx(SAFETY)


def test_the_step_settles_where_the_error_is_what_is_allowed():
    """On a problem whose error is exactly (Δt/h)^k the controller finds h from far away and stays."""
    controller, size = Controller(4), 1e-3
    for _ in range(60):
        error = (size / 0.37) ** 4
        factor = controller.factor(size, error)
        controller = controller if error > 1 else controller.accepted(size, error)
        size *= factor
    assert 0.5 < size / 0.37 <= 1
    assert factor == pytest.approx(1, abs=1e-3)


def test_a_growing_error_is_anticipated():
    """The same error after a smaller one asks for a shorter step than after an equal one."""
    rising, steady = Controller(4, 0.1, 0.1), Controller(4, 0.1, 0.5)
    assert rising.factor(0.1, 0.5) < steady.factor(0.1, 0.5)


@given(proposal=SIZES, reusable=st.none() | SIZES)
def test_a_factored_size_is_kept_for_a_little_longer_step_only(proposal, reusable):
    size = settle_on(proposal, reusable)
    assert size <= proposal
    assert size == proposal or (size == reusable and proposal <= WORTH_CHANGING * reusable)


CHANGES_OF_SIGN = {
    "straight": lambda x: x - 0.3,
    "cubic": lambda x: (x - 0.3) ** 3,
    "falling": lambda x: np.exp(-5 * x) - np.exp(-1.5),
    "flat then steep": lambda x: x**9 - 0.3**9,
    "jump": lambda x: 1.0 if x > 0.3 else -1.0,
    "falling jump": lambda x: 1e-9 if x < 0.3 else -1e9,
    "jump on a slope": lambda x: x + (1 if x > 0.3 else -1),
}


@pytest.mark.parametrize("function", CHANGES_OF_SIGN.values(), ids=CHANGES_OF_SIGN.keys())
@pytest.mark.parametrize("tolerance", [1e-3, 1e-12])
def test_a_change_of_sign_is_found_on_the_side_of_the_end(function, tolerance):
    calls = []

    def counted(x):
        calls.append(x)
        return function(x)

    root = bracketed_root(counted, 0.0, 1.0, tolerance)
    assert -1e-15 <= root - 0.3 <= tolerance
    assert (function(root) > 0) == (function(1.0) > 0) or function(root) == 0
    assert len(calls) < MOST_EVALUATIONS
    assert all(0 <= x <= 1 for x in calls)


@given(where=st.floats(0.01, 0.99), low=st.floats(-1e6, -1e-6), high=st.floats(1e-6, 1e6))
def test_any_jump_is_bracketed_in_few_evaluations(where, low, high):
    calls = []

    def jump(x):
        calls.append(x)
        return high if x > where else low

    root = bracketed_root(jump, 0.0, 1.0, 1e-9)
    assert 0 <= root - where <= 1e-9
    assert len(calls) < 110


def test_an_exact_zero_ends_the_search():
    assert bracketed_root(lambda x: x - 0.5, 0.0, 1.0, 1e-12) == pytest.approx(0.5, abs=1e-12)
    assert bracketed_root(lambda x: x - 1.0, 0.0, 1.0, 1e-12) == 1.0


@pytest.mark.parametrize("root", [0.1, 0.37, 0.93])
def test_of_a_smooth_function_the_bracket_need_not_close(root):
    calls = []

    def function(x):
        calls.append(x)
        return np.expm1(x - root) + 0.3 * (x - root) ** 2

    ends = (0.0, function(0.0)), (1.0, function(1.0))
    closed = root_between(function, *ends, 1e-9)
    needed = len(calls)
    found = root_between(function, *ends, 1e-9, smooth=True)
    assert found == pytest.approx(root, abs=1e-9)
    assert closed == pytest.approx(root, abs=1e-9)
    assert len(calls) - needed < needed - 2


@pytest.mark.parametrize("root", [-1e-7, 1 + 1e-7])
def test_a_root_just_beyond_an_end_is_found_at_that_end(root):
    found = root_between(lambda x: np.expm1(x - root), (0.0, -0.6), (1.0, 0.9), 1e-9)
    assert found == pytest.approx(root, abs=2e-7)
    assert 0 <= found <= 1
