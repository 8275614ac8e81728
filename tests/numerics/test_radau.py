"""Radau IIA by the identities that define it [Hairer & Wanner, Solving ODEs II, IV.5 and IV.8]."""

from math import sqrt

import numpy as np
import pytest

from rodloop_cli.numerics.radau import radau_iia

METHODS = pytest.mark.parametrize("stages", [1, 3, 5, 7])
ROUND_OFF = 1e-12


@METHODS
def test_quadrature_has_order_2s_minus_1(stages):
    """B(2s - 1), the weights being the last row of A."""
    method = radau_iia(stages)
    weights = method.matrix[-1]
    for k in range(1, 2 * stages):
        assert weights @ method.nodes ** (k - 1) == pytest.approx(1 / k, abs=ROUND_OFF)
    assert abs(weights @ method.nodes ** (2 * stages - 1) - 1 / (2 * stages)) > 1e-9


@METHODS
def test_stages_collocate(stages):
    """C(s): A integrates polynomials below degree s."""
    method = radau_iia(stages)
    for k in range(1, stages + 1):
        np.testing.assert_allclose(method.matrix @ method.nodes ** (k - 1), method.nodes**k / k, atol=ROUND_OFF)


@METHODS
def test_the_transposed_condition(stages):
    """D(s - 1): Σ_i b_i c_i^(k-1) a_ij = b_j (1 - c_j^k)/k."""
    method = radau_iia(stages)
    weights = method.matrix[-1]
    for k in range(1, stages):
        left = (weights * method.nodes ** (k - 1)) @ method.matrix
        np.testing.assert_allclose(left, weights * (1 - method.nodes**k) / k, atol=ROUND_OFF)


@METHODS
def test_stiffly_accurate_and_therefore_damping(stages):
    """The end of the step is the last stage, and R(∞) = 1 - bᵀA⁻¹1 = 0."""
    method = radau_iia(stages)
    assert method.nodes[-1] == 1.0
    assert ((method.nodes > 0) & (np.diff(method.nodes, prepend=0) > 0)).all()
    np.testing.assert_allclose(method.matrix[-1] @ method.inverse, np.eye(stages)[-1], atol=1e-11)


def stability_function(method, z):
    """R(z) = 1 + z bᵀ(1 - zA)⁻¹1."""
    one = np.ones(method.stages)
    return 1 + z * method.matrix[-1] @ np.linalg.solve(np.eye(method.stages) - z * method.matrix, one)


@pytest.mark.parametrize(("stages", "step"), [(1, 0.02), (3, 0.4), (5, 1.5)])
def test_the_exponential_to_order_2s_minus_1(stages, step):
    """On the imaginary axis, where the term after the leading one of the error is at a right angle to it."""
    method = radau_iia(stages)
    errors = [abs(stability_function(method, 1j * z) - np.exp(1j * z)) for z in (step, step / 2)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2 * stages, abs=0.1)


@METHODS
def test_waves_do_not_grow(stages):
    """A-stability on the imaginary axis, where the bending waves are."""
    method = radau_iia(stages)
    assert all(abs(stability_function(method, 1j * z)) <= 1 + 1e-12 for z in np.logspace(-3, 5, 60))


def test_one_stage_is_backward_euler():
    method = radau_iia(1)
    assert method.nodes.tolist() == [1.0]
    assert method.matrix.tolist() == [[1.0]]


def test_three_stages_are_radau5():
    method = radau_iia(3)
    root = sqrt(6)
    np.testing.assert_allclose(method.nodes, [(4 - root) / 10, (4 + root) / 10, 1], atol=1e-15)
    np.testing.assert_allclose(method.embedded, np.array([-13 - 7 * root, -13 + 7 * root, -1]) / 3, rtol=1e-12)
    np.testing.assert_allclose(
        method.eigenvalues, [3.637834252744496, 2.681082873627752 + 3.050430199247411j], rtol=1e-13
    )
    table = [
        [(88 - 7 * root) / 360, (296 - 169 * root) / 1800, (-2 + 3 * root) / 225],
        [(296 + 169 * root) / 1800, (88 + 7 * root) / 360, (-2 - 3 * root) / 225],
        [(16 - root) / 36, (16 + root) / 36, 1 / 9],
    ]
    np.testing.assert_allclose(method.matrix, table, atol=1e-15)


@METHODS
def test_the_eigenvectors_take_the_stages_apart_and_together(stages):
    method = radau_iia(stages)
    assert method.eigenvalues[0].imag == 0
    assert (method.eigenvalues[1:].imag > 0).all()
    values = np.random.default_rng(stages).normal(size=stages)
    coordinates = method.to_modes @ values
    np.testing.assert_allclose((method.from_modes @ coordinates).real, values, atol=1e-10)
    applied = (method.from_modes @ (method.eigenvalues * coordinates)).real
    np.testing.assert_allclose(applied, method.inverse @ values, atol=1e-9)


@METHODS
def test_the_embedded_formula_is_of_order_s(stages):
    """It vanishes for motions of degree below s and not for degree s: with z_i = c_i^k Δt^k and f_0 the slope at 0."""
    method = radau_iia(stages)
    for k in range(1, stages + 1):
        estimate = float(k == 1) + method.embedded @ method.nodes**k
        assert estimate == pytest.approx(0, abs=1e-9)
    assert abs(method.embedded @ method.nodes ** (stages + 1)) > 1e-4
