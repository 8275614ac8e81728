"""Single numbers that the program must find: minima of the area, crossings, equilibria."""

import numpy as np
import pytest

from rodloop_cli import Case, simulate
from rodloop_cli.numerics.gauss import gauss_rule
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.energies import Quadrature
from rodloop_cli.physics.equations import Load
from rodloop_cli.physics.rod import LENGTH, Mesh, Rod, Segment
from rodloop_cli.statics import unloaded


@pytest.mark.parametrize(
    ("case", "area", "time", "accuracy"),
    [
        pytest.param({"stiffness_ratio": 5.0, "t_end": 1.3}, 2.20143, 1.1329, 5e-4, id="Fig. 9"),
        pytest.param(
            {"perturbation": [{"mode": 2, "amplitude": 5e-3}], "t_end": 5.0}, 1.02928, 4.7624, 1e-3, id="Fig. 3"
        ),
    ],
)
def test_the_first_minimum_of_the_area(case, area, time, accuracy):
    found = simulate(Case(p=3.8, snapshots=2, **case)).attrs
    assert found["first_area_minimum"] == pytest.approx(area, abs=accuracy)
    assert found["first_area_minimum_time"] == pytest.approx(time, abs=accuracy)


@pytest.mark.parametrize(
    ("ratio", "p", "time"), [(2.0, 16.0, 0.770), (2.0, 64.0, 0.240), (5.0, 32.0, 0.350), (5.0, 128.0, 0.127)]
)
def test_the_first_crossing_ends_the_run(ratio, p, time):
    run = simulate(Case(p=p, stiffness_ratio=ratio, t_end=1.0, snapshots=2))
    assert run.attrs["first_crossing_time"] == pytest.approx(time, rel=1e-2)
    assert run.t.values[-1] == run.attrs["first_crossing_time"]
    assert "first crossing" in run.attrs["outcome"]


@pytest.mark.parametrize(("ratio", "energy", "area"), [(5.0, 51.96382, 0.07731161), (12.8, 96.84788, 0.06993582)])
@pytest.mark.parametrize("soft_first", [True, False])
def test_the_unloaded_equilibrium_of_two_halves(ratio, energy, area, soft_first):
    """Bending energy by B1/L and area by L², B1 being the softer half's stiffness."""
    halves = (Segment(0.5), Segment(0.5, ratio))
    rod, rule = Rod(halves if soft_first else halves[::-1]), gauss_rule(6)
    mesh = Mesh.on(rod, (6, 6))
    unknowns = unloaded(mesh, rule)
    fields, quadrature = BoxEquations(mesh, rule, Load(0.0)).fields(unknowns[None], None), Quadrature(mesh, rule)
    bending = quadrature.bending(fields.moment[..., :-1])[0]
    enclosed = quadrature.area(fields.position[..., :-1], np.stack([fields.cosine, fields.sine]))[0]
    assert bending * LENGTH == pytest.approx(energy, abs=6e-6)
    assert enclosed / LENGTH**2 == pytest.approx(area, abs=6e-9)
