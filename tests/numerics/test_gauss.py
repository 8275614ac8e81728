"""Collocation in the unit cell: what a Gauss rule integrates and interpolates exactly."""

import numpy as np
import pytest

from rodloop_cli.numerics.gauss import gauss_rule, lagrange_derivative, lagrange_matrix

RULES = pytest.mark.parametrize("m", [1, 2, 3, 4, 6, 8, 10])
ROUND_OFF = 1e-13


@RULES
def test_the_weights_integrate_polynomials_below_degree_2m(m):
    rule = gauss_rule(m)
    for degree in range(2 * m):
        assert rule.weights @ rule.points**degree == pytest.approx(1 / (degree + 1), abs=ROUND_OFF)


@RULES
def test_no_rule_is_better_than_its_order(m):
    rule = gauss_rule(m)
    defect = rule.weights @ (2 * rule.points - 1) ** (2 * m) - 1 / (2 * m + 1)
    assert abs(defect) > 1e-7


@RULES
def test_integrals_to_the_points_are_exact_below_degree_m(m):
    rule = gauss_rule(m)
    for degree in range(m):
        integral = rule.points**degree @ rule.to_points_and_end
        np.testing.assert_allclose(integral[:-1], rule.points ** (degree + 1) / (degree + 1), atol=ROUND_OFF)
        assert integral[-1] == pytest.approx(1 / (degree + 1), abs=ROUND_OFF)


@RULES
def test_the_rule_looks_the_same_from_both_ends(m):
    rule = gauss_rule(m)
    np.testing.assert_allclose(rule.points, 1 - rule.points[::-1], atol=ROUND_OFF)
    np.testing.assert_allclose(rule.weights, rule.weights[::-1], atol=ROUND_OFF)
    from_the_end = rule.weights[:, None] - rule.to_points
    np.testing.assert_allclose(rule.to_points, from_the_end[::-1, ::-1], atol=ROUND_OFF)


@RULES
def test_gauss_collocation_is_symplectic(m):
    """b_i a_ij + b_j a_ji = b_i b_j; ``to_points`` is the transposed Runge-Kutta matrix."""
    rule = gauss_rule(m)
    product = rule.weights[:, None] * rule.to_points.T
    np.testing.assert_allclose(product + product.T, np.outer(rule.weights, rule.weights), atol=ROUND_OFF)


@RULES
def test_legendre_coefficients_of_legendre_polynomials(m):
    rule = gauss_rule(m)
    for j, unit in enumerate(np.eye(m)):
        samples = np.polynomial.legendre.legval(2 * rule.points - 1, unit)
        np.testing.assert_allclose(samples @ rule.legendre, np.eye(m)[j], atol=ROUND_OFF)


def test_lagrange_interpolation_is_exact_for_its_degree():
    nodes, points = np.array([0.0, 0.1, 0.45, 0.8, 1.0]), np.array([-0.2, 0.0, 0.3, 0.45, 1.7])
    values, slopes = lagrange_matrix(nodes, points), lagrange_derivative(nodes, points)
    for degree in range(5):
        np.testing.assert_allclose(values @ nodes**degree, points**degree, atol=1e-12)
        np.testing.assert_allclose(slopes @ nodes**degree, degree * points ** max(degree - 1, 0), atol=1e-11)


def test_interpolation_at_a_node_gives_the_value_there():
    nodes = np.array([0.0, *gauss_rule(8).points, 1.0])
    np.testing.assert_array_equal(lagrange_matrix(nodes, nodes), np.eye(10))
