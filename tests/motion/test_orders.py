"""Orders of accuracy in space and time: on equilibria, on exact motions and on short smooth ones."""

from functools import cache
from itertools import pairwise
from math import cos, exp, sin

import numpy as np
import pytest

from rodloop_cli import Case
from rodloop_cli.march.radau import RadauStepper, started
from rodloop_cli.march.state import State
from rodloop_cli.march.work import Work
from rodloop_cli.numerics.gauss import gauss_rule
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import NODAL, Load, X, Y
from rodloop_cli.physics.rod import Mesh, Rod, Segment
from rodloop_cli.physics.shapes import Wave, circle, perturbed
from rodloop_cli.simulation import Run
from rodloop_cli.statics import laid_on, relax, unloaded

HALVES = Rod((Segment(0.5), Segment(0.5, 5.0)))
EXACTLY = 1e-12
"""What Newton's method is asked for: nothing but the order of the scheme is left."""


@cache
def equilibrium_nodes(cells, m, p):
    """(8, 2): positions at eight nodes of every mesh, from a centre and an orientation that all have in common."""
    mesh, rule = Mesh.on(HALVES, (cells // 2, cells // 2)), gauss_rule(m)
    unknowns = unloaded(mesh, rule)
    if p:
        unknowns = relax(BoxEquations(mesh, rule, Load(p)), unknowns)
    nodes = unknowns[:: cells // 8, X : Y + 1]
    return nodes - nodes.mean(axis=0)


def distances(nodes):
    return np.hypot(*(nodes[:, None] - nodes[None]).transpose(2, 0, 1))


@pytest.mark.parametrize("p", [0.0, 2.0])
@pytest.mark.parametrize(("m", "cells", "bound"), [(1, 32, 6e-3), (2, 16, 1e-3), (3, 32, 1e-8)])
def test_order_2m_in_the_cell_length_at_the_nodes_of_an_equilibrium(p, m, cells, bound):
    exact = distances(equilibrium_nodes(32, 6, p))
    coarse, fine = (np.abs(distances(equilibrium_nodes(n, m, p)) - exact).max() for n in (cells, 2 * cells))
    assert fine < bound
    assert np.log2(coarse / fine) == pytest.approx(2 * m, abs=0.3)


def in_fixed_steps(state, stages, steps, t_end, accuracy=EXACTLY):
    """The state after equal steps, each solved with a linearisation of its own."""
    for _ in range(steps):
        step = RadauStepper(stages, Work()).step(state, None, t_end / steps, accuracy)
        assert step is not None
        state = step.end
    return state


def smooth_start(m=6, cells=8):
    """A homogeneous loop away from any equilibrium, just released."""
    mesh, rule = Mesh.on(Rod(), (cells,)), gauss_rule(m)
    unknowns = laid_on(perturbed(circle(), (Wave(2, 0.003),), Rod()), mesh, rule)
    state = State.at_rest(BoxEquations(mesh, rule, Load(8.0)), unknowns)
    return started(state, 1e-6)[0]


@pytest.mark.parametrize(("values", "order", "bound"), [("position", 5, 1e-7), ("velocity", 3, 2e-5)])
def test_three_stages_in_the_time_step(values, order, bound):
    """Of an index-3 system the positions keep the order 2s - 1, the velocities s, where the motion is smooth."""
    start = smooth_start()
    runs = [getattr(in_fixed_steps(start, 3, steps, 1.0), values) for steps in (8, 16, 32)]
    coarse, fine = (np.abs(a - b).max() for a, b in pairwise(runs))
    assert fine < bound
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.3)


def spinning(equations, spin, drift):
    """A circle of unit radius about the origin that turns at the rate ``spin`` and moves at ``drift`` (2,)."""
    unknowns = laid_on(circle(), equations.mesh, equations.rule)
    state = State.at_rest(equations, unknowns)
    x, y = state.position
    velocity = spin * np.stack([-y, x]) + np.array(drift)[:, None, None]
    rates = np.zeros_like(unknowns)
    rates[:, X : Y + 1] = np.roll(velocity[..., -1], 1, axis=-1).T
    rates[:, [2, *range(NODAL, rates.shape[1])]] = spin
    return State(0.0, equations, unknowns, rates, state.position, velocity, state.acceleration, state.force)


@pytest.mark.parametrize(("zeta", "gamma"), [(0.0, 0.5), (0.9, 1.0)])
@pytest.mark.parametrize("density", [1.0, 3.0])
def test_a_circle_spins_and_drifts_as_a_rigid_body(zeta, gamma, density):
    """The exact motion: drag that is the same in all directions slows both down by e^(-ζt/ρ)."""
    spin, drift, t_end = 1.2, (0.3, -0.1), 1.0
    rod = Rod((Segment(1.0, 1.0, density),))
    equations = BoxEquations(Mesh.on(rod, (8,)), gauss_rule(6), Load(1.5, zeta, gamma))
    rate = zeta / density
    passed = (1 - exp(-rate * t_end)) / rate if rate else t_end
    c, s = cos(spin * passed), sin(spin * passed)
    start = spinning(equations, spin, drift)
    exact = np.einsum("ij,jnm->inm", [[c, -s], [s, c]], start.position) + passed * np.array(drift)[:, None, None]
    end = in_fixed_steps(start, 3, 12, t_end, accuracy=1e-9)
    np.testing.assert_allclose(end.position, exact, atol=1e-7)
    turning = spin * np.einsum("ij,jnm->inm", [[-s, -c], [c, -s]], start.position)
    expected = exp(-rate * t_end) * (turning + np.array(drift)[:, None, None])
    np.testing.assert_allclose(end.velocity, expected, atol=1e-4)


@pytest.mark.parametrize("scheme", [{"tol": 1e-4}, {"scheme": "bdf2", "N": 32, "dt": 0.01}], ids=["radau", "bdf2"])
@pytest.mark.parametrize("drag", [0.0, 2.0])
def test_solved_stages_leave_no_residual(scheme, drag):
    """Every step that a scheme hands on balances (10)-(13) as far as Newton's method was asked to go."""
    run = Run.of(Case(p=3.8, stiffness_ratio=5.0, zeta_perp=drag, t_end=0.2, **scheme))
    for step in run.marcher:
        residual = step.start.equations.residual(step.unknowns, step.fields)
        assert float(np.abs(residual[..., [X, Y]]).max()) < 1e-6
        np.testing.assert_array_equal(step.end.position, step.fields.position[:, -1])
