"""Orders in space and time, and how small the errors are, on a motion that is known exactly: see `manufactured`.

The loop bends, turns and drifts under pressure, drag and rotary inertia, over junctions of stiffness and density; an
error in any term of (10)-(13) or of their time derivatives leaves an error that no refinement takes away.
"""

import numpy as np
import pytest

from rodloop_cli.march.bdf2 import FixedMarcher
from rodloop_cli.march.predictor import Past
from rodloop_cli.march.radau import RadauStepper
from rodloop_cli.march.work import Work
from rodloop_cli.numerics.radau import radau_iia

from .manufactured import Forced, ForcedLoop, errors, state_at

T_END = 0.5
EXACTLY = 5e-12
"""What Newton's method is asked for: nothing but the order of the scheme is left."""
IN_MOTION = 0.2
"""A start at which a first step of backward Euler has something to spoil."""


@pytest.fixture(params=["boxes", "whole loop"])
def _form(request, monkeypatch):
    """The two ways to solve the equations of a step, neither left to the number of points."""
    monkeypatch.setattr("rodloop_cli.march.radau.MOST_FULL", 0 if request.param == "boxes" else 1000)
    monkeypatch.setattr("rodloop_cli.march.radau.LoopEquations", ForcedLoop)


def radau(cells, m, stages, steps):
    """Errors of equal steps of Radau IIA, their mean over the steps."""
    state, last, stepper, size = state_at(0.0, cells, m), None, RadauStepper(stages, Work()), T_END / steps
    found = []
    for _ in range(steps):
        Forced.times = state.time + size * radau_iia(stages).nodes
        step = stepper.step(state, last, size, EXACTLY)
        assert step is not None
        state, last = step.end, Past.of(step)
        found.append(errors(state))
    return mean(found)


def bdf2(cells, m, steps, start=0.0):
    """Errors of the paper's time stepping, their mean over the second half of the steps."""
    state, size, found = state_at(start, cells, m), (T_END - start) / steps, []
    marcher = FixedMarcher(state, T_END, size, Work())
    march = iter(marcher)
    for _ in range(steps):
        Forced.times = np.array([marcher.state.time + size])
        found.append(errors(next(march).end))
    assert marcher.work.newton_failures == 0
    return mean(found[steps // 2 :])


def mean(found):
    return {name: float(np.mean([row[name] for row in found])) for name in found[0]}


def check(coarse, fine, ratio, bounds, order):
    """The errors named in ``bounds`` show the order (one for all, or by name), and those of the finer run are below."""
    for name, bound in bounds.items():
        wanted = order[name] if isinstance(order, dict) else order
        slope = np.log(coarse[name] / fine[name]) / np.log(ratio)
        assert slope == pytest.approx(wanted, abs=0.1), f"{name}: slope {slope:.3f}, errors {coarse} and {fine}"
        assert fine[name] < bound, f"{name}: {fine[name]:.2e}"


EVERYTHING = ("position", "angle", "velocity", "acceleration", "moment", "force")


@pytest.mark.usefixtures("_form")
@pytest.mark.parametrize(
    ("m", "cells", "bounds"),
    [
        (1, (10, 15), dict(zip(EVERYTHING, (8e-4, 5e-4, 1.2e-3, 2e-2, 3e-3, 8e-3), strict=True))),
        (2, (10, 15), {"position": 2e-7, "angle": 5e-7, "velocity": 1.2e-6, "moment": 3e-6, "force": 1.5e-5}),
        (3, (10, 15), {"position": 1e-10, "angle": 5e-10}),
        (4, (4, 6), {"position": 2e-10}),
    ],
)
def test_order_2m_in_the_cell_length(m, cells, bounds):
    """At the nodes, for m Gauss points in a cell; m = 1 is the paper's box. Time is as good as exact."""
    coarse, fine = (radau(n, m, 7, 24) for n in cells)
    check(coarse, fine, cells[1] / cells[0], bounds, 2 * m)


@pytest.mark.usefixtures("_form")
@pytest.mark.parametrize(
    ("stages", "steps", "bounds"),
    [
        (3, (48, 72), {"position": 1.5e-10, "velocity": 1e-6, "acceleration": 1.1e-3, "force": 1.1e-3}),
        (5, (40, 60), {"velocity": 8e-10, "acceleration": 2e-6, "force": 2e-6}),
        (7, (12, 18), {"velocity": 6e-10}),
    ],
)
def test_orders_of_radau_in_the_time_step(stages, steps, bounds):
    """2s - 1 in position, s in velocity, s - 1 in acceleration and force: the orders for systems of index 3 [Hairer,
    Lubich & Roche 1989; Jay 1993].

    Of five and seven stages the positions' order cannot be seen: their errors are what Newton's method leaves. The
    forces of seven stages come down to order 6 from above and are at 6.15 when that ends it.
    """
    order = {"position": 2 * stages - 1, "velocity": stages, "acceleration": stages - 1, "force": stages - 1}
    coarse, fine = (radau(2, 10, stages, n) for n in steps)
    check(coarse, fine, steps[1] / steps[0], bounds, order)
    if stages > 3:
        assert fine["position"] < 1e-11


@pytest.mark.parametrize(
    ("cells", "m", "steps", "start", "bounds"),
    [
        ((2, 2), 10, (64, 128), IN_MOTION, (2e-4, 1e-4, 6e-4, 1e-3, 1.5e-4, 1e-3)),
        ((24, 36), 1, (48, 72), 0.0, (2.5e-3, 2e-3, 8e-3, 1.5e-2, 3e-3, 1.2e-2)),
    ],
    ids=["time", "time and space"],
)
def test_second_order_of_the_papers_scheme(cells, m, steps, start, bounds):
    """In time on cells that are as good as exact, and on the paper's boxes in both together."""
    coarse, fine = (bdf2(n, m, count, start) for n, count in zip(cells, steps, strict=True))
    check(coarse, fine, steps[1] / steps[0], dict(zip(EVERYTHING, bounds, strict=True)), 2)
