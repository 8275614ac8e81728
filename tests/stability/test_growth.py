"""What the linear theory predicts, measured in the nonlinear motion."""

import numpy as np
import pytest

from rodloop_cli import Case, simulate
from rodloop_cli.march.loop import Departure, Marcher, Plan
from rodloop_cli.march.refine import Refiner
from rodloop_cli.march.state import State
from rodloop_cli.march.work import Work
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.closure import Closure
from rodloop_cli.physics.equations import NODAL, Load
from rodloop_cli.physics.rod import Rod, Segment
from rodloop_cli.stability.modes import ModeSearch, base_state, modes_at
from rodloop_cli.stability.spectrum import eigenmotions

AMPLITUDE = 1e-6
UNIFORM = Rod()
DENSE = Rod((Segment(0.5), Segment(0.5, 1.0, 5.0)))
BENT = Rod((Segment(0.3), Segment(0.7, 1.3, 2.0)))
"""Unstable at p = 7, past the bifurcation at 5.14."""


@pytest.mark.parametrize("drag", [0.0, 1.0])
@pytest.mark.parametrize(
    ("rod", "p", "mode", "zeta"),
    [(UNIFORM, 16.0, 0, 3.0), (UNIFORM, 16.0, 4, 3.0), (DENSE, 16.0, 0, 3.0), (BENT, 7.0, 0, 0.3)],
)
def test_a_small_eigenmode_grows_as_predicted(rod, p, mode, zeta, drag):
    load = Load(p, drag * zeta, 0.5)
    base = base_state(rod, p, 12)
    motion = eigenmotions(base, 8, load)[mode]
    rate = motion.rate.real
    assert (rate > 0.1, motion.rate.imag) == (True, 0.0)
    grown = 4.0 / rate
    states = run(departing(base, motion, load), grown)
    size = np.array([np.abs(state.unknowns[:, NODAL:] - base.unknowns[:, NODAL:]).max() for state in states])
    times = np.array([state.time for state in states])
    late = times > grown / 2
    slopes = np.polyfit(times[late], np.log(size[late]), 1)
    assert slopes[0] == pytest.approx(rate, rel=1e-2)
    assert size[-1] / size[0] == pytest.approx(np.exp(4.0), rel=4e-2)


@pytest.mark.parametrize("zeta", [0.0, 1.2])
def test_a_stable_mode_swings_at_its_frequency_and_decays(zeta):
    rod, load = Rod((Segment(0.5), Segment(0.5, 5.0, 2.0))), Load(3.8, zeta, 0.5)
    base = base_state(rod, load.p, 12)
    motion = min(eigenmotions(base, 8, load), key=lambda motion: motion.rate.imag)
    period = 2 * np.pi / motion.rate.imag
    last = run(departing(base, motion, load), period)[-1]
    change = (last.unknowns - base.unknowns)[:, NODAL:]
    expected = AMPLITUDE * (motion.unknowns * np.exp(motion.rate * period)).real[:, NODAL:]
    assert np.abs(change - expected).max() < 1e-2 * AMPLITUDE * np.abs(motion.unknowns[:, NODAL:]).max()


@pytest.mark.parametrize(("p", "lobes", "rate"), [(16, 3, 7.59), (32, 4, 15.5), (64, 6, 31.0), (128, 8, 63.5)])
def test_the_lobes_of_the_early_motion_are_those_of_the_fastest_mode(p, lobes, rate):
    waves = [{"mode": n, "amplitude": 1e-7, "phase": float(n * n)} for n in range(2, 13)]
    run = simulate(Case(p=p, t_end=13 / rate, perturbation=waves, snapshot_times=(9 / rate, 11 / rate, 13 / rate)))
    assert run.attrs["outcome"] == "reached t_end"
    assert run["lobes"].values.tolist() == [lobes] * 3
    assert modes_at(Rod(), Load(p), ModeSearch()).lobes == lobes


def departing(base, motion, load):
    """The base state with a small eigenmode on it and its velocity, closed to round-off."""
    equations = BoxEquations(base.equations.mesh, base.equations.rule, load)
    closure = Closure(equations)
    unknowns = base.unknowns + AMPLITUDE * motion.unknowns.real
    rates = AMPLITUDE * (motion.rate * motion.unknowns).real
    acceleration = AMPLITUDE * (motion.rate**2 * motion.unknowns).real
    position = closure.position(unknowns, closure.centre(equations.shape(unknowns[None])[1][:, 0]))
    velocity = closure.velocity(unknowns, rates, closure.centre(base.displacement(rates)))
    force = equations.fields(unknowns[None], None).force[:, 0]
    return State(0.0, equations, unknowns, rates, position, velocity, base.displacement(acceleration), force)


def run(state, t_end):
    plan = Plan(t_end=t_end, tol=1e-4, stages=5, longest=t_end / 20, first=t_end / 100)
    steps = Marcher(state, plan, Refiner(fixed=True), Departure(AMPLITUDE), Work())
    return [state, *(step.end for step in steps)]
