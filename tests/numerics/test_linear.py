"""The solvers of periodic block systems against dense elimination."""

import numpy as np
import pytest

from rodloop_cli.errors import SingularSystem
from rodloop_cli.numerics.condensed import CondensedSystems
from rodloop_cli.numerics.cyclic import CyclicFactorization, folded_layout

NODES = pytest.mark.parametrize("nodes", range(2, 10))


def random(shape, seed, kind):
    generator = np.random.default_rng(seed)
    values = generator.normal(size=shape)
    return values + 1j * generator.normal(size=shape) if kind is complex else values


def dense_loop(transfers):
    """(n b, n b): z_{i+1} - G_i z_i with z_n = z_0."""
    nodes, block, _ = transfers.shape
    matrix = np.zeros((nodes, block, nodes, block), dtype=transfers.dtype)
    for i in range(nodes):
        matrix[i, :, (i + 1) % nodes, :] += np.eye(block)
        matrix[i, :, i, :] -= transfers[i]
    return matrix.reshape(nodes * block, -1)


def cyclic_residual(transfers, solution):
    """(n, b): z_{i+1} - G_i z_i."""
    return np.roll(solution, -1, axis=0) - np.einsum("nij,nj->ni", transfers, solution)


@NODES
@pytest.mark.parametrize("block", [1, 2, 6])
@pytest.mark.parametrize("kind", [float, complex])
def test_a_periodic_system_is_solved_like_a_dense_one(nodes, block, kind):
    transfers = random((nodes, block, block), nodes, kind)
    right_hand_side = random((nodes, block), nodes + 1, kind)
    solution = CyclicFactorization(transfers).solve(right_hand_side.copy())
    expected = np.linalg.solve(dense_loop(transfers), right_hand_side.ravel()).reshape(nodes, block)
    np.testing.assert_allclose(solution, expected, rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(cyclic_residual(transfers, solution), right_hand_side, atol=1e-9)


def test_fast_growing_solutions_do_no_harm():
    """Marching round the loop would lose 30 digits here."""
    transfers = np.tile(np.diag([1e3, 1e-3]), (10, 1, 1))
    right_hand_side = random((10, 2), 3, float)
    solution = CyclicFactorization(transfers).solve(right_hand_side)
    np.testing.assert_allclose(cyclic_residual(transfers, solution), right_hand_side, atol=1e-10)


def test_a_loop_without_a_unique_solution_is_refused():
    with pytest.raises(SingularSystem):
        CyclicFactorization(np.zeros((4, 2, 2)) + np.eye(2))


@NODES
def test_the_folded_order_is_a_permutation_that_keeps_neighbours_close(nodes):
    layout = folded_layout(nodes, 6)
    assert sorted(layout.node_order) == sorted(layout.equation_order) == list(range(nodes))
    gap = np.abs(layout.node_position - np.roll(layout.node_position, -1))
    assert gap.max() <= 2


def dense_boxes(responses, block):
    """(n (b + m),)² of δz_{i+1} - A δz_i - B δw = r, δw - C δz_i - D δw = q."""
    nodes, size, _ = responses.shape
    matrix = np.zeros((nodes, size, nodes, size), dtype=responses.dtype)
    for i in range(nodes):
        matrix[i, :, i, :] -= responses[i]
        matrix[i, :block, (i + 1) % nodes, :block] += np.eye(block)
        matrix[i, block:, i, block:] += np.eye(size - block)
    return matrix.reshape(nodes * size, -1)


@pytest.mark.parametrize("nodes", [2, 3, 7])
@pytest.mark.parametrize("inner", [1, 4])
def test_eliminating_inner_unknowns_changes_no_solution(nodes, inner):
    """Three systems on one mesh: the first real, the others complex."""
    responses = random((3, nodes, 3 + inner, 3 + inner), nodes, complex)
    responses[0] = responses[0].real
    right_hand_sides = random((3, nodes, 3 + inner), inner, complex)
    right_hand_sides[0] = right_hand_sides[0].real
    systems = CondensedSystems(responses, 3)
    solutions = systems.solve(right_hand_sides.copy())
    for response, right_hand_side, solution in zip(responses, right_hand_sides, solutions, strict=True):
        residual = dense_boxes(response, 3) @ solution.ravel() - right_hand_side.ravel()
        np.testing.assert_allclose(residual, 0, atol=1e-9)
    np.testing.assert_allclose(systems.solve_real(right_hand_sides[0].real), solutions[0].real, atol=1e-11)
