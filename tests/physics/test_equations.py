"""The balance laws: against the forms of the paper written out a second time, and against their own derivatives."""

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rodloop_cli.numerics.gauss import gauss_rule
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import FX, FY, MOMENT, NODAL, THETA, Load, Motion, X, Y
from rodloop_cli.physics.rod import Mesh, Rod, Segment

LOADS = {
    "pressure": Load(p=3.8),
    "inner film": Load(p=-7.0),
    "drag": Load(p=2.0, zeta_perp=1.7, gamma=0.3),
    "tangential drag": Load(p=0.0, zeta_perp=0.8, gamma=2.5),
    "rotary inertia": Load(p=1.5, zeta_perp=0.4, rotary_inertia=0.3),
}
RODS = {
    "one": Rod(),
    "two": Rod((Segment(0.5), Segment(0.5, 5.0, 3.0))),
    "three": Rod((Segment(0.2), Segment(0.3, 0.1, 7.0), Segment(0.5, 12.8, 0.4))),
}
CASES = pytest.mark.parametrize(("rod", "load"), [(rod, load) for rod in RODS for load in LOADS], ids=lambda key: key)


def equations_of(rod, load, m=3):
    return BoxEquations(Mesh.on(RODS[rod], tuple(range(2, 2 + len(RODS[rod].segments)))), gauss_rule(m), LOADS[load])


def random_loop(equations, stages=1, seed=0):
    """Unknowns (k, n, 6 + m) of no particular shape."""
    n, m = equations.mesh.cells, equations.rule.m
    return np.random.default_rng(seed).normal(size=(stages, n, NODAL + m))


def random_motion(equations, stages=1, seed=0):
    generator = np.random.default_rng(seed + 1)
    shape = (2, stages, equations.mesh.cells, equations.rule.m + 1)
    rates, velocity, acceleration = (generator.normal(size=size) for size in ((stages, stages), shape, shape))
    spin, spin_rate = generator.normal(size=(2, *shape[1:-1], shape[-1] - 1))
    return Motion(rates, velocity, acceleration, spin, spin_rate)


def integrals(equations, slope):
    """(…, n, m + 1): integral from the left end of each cell of samples (…, n, m) at the Gauss points."""
    rule = equations.rule
    to_points = np.stack([slope @ rule.to_points[:, j] for j in range(rule.m)], axis=-1)
    return np.concatenate([to_points, (slope @ rule.weights)[..., None]], -1) * equations.mesh.lengths[:, None]


@CASES
def test_every_field_is_the_integral_of_its_law(rod, load):
    """Eqs. (10)-(13) term by term as printed in the module's head, which is the paper's form without its misprints."""
    equations = equations_of(rod, load)
    unknowns, motion = random_loop(equations, 2), random_motion(equations, 2)
    fields = equations.fields(unknowns, motion)
    angle, (p, zeta, gamma) = unknowns[..., NODAL:], (LOADS[load].p, LOADS[load].zeta_perp, LOADS[load].gamma)
    c, s = np.cos(angle), np.sin(angle)
    b, rho = equations.mesh.stiffness[:, None], equations.mesh.density[:, None]
    (u, v), (ax, ay) = fields.velocity[..., :-1], fields.acceleration[..., :-1]
    fx, fy = fields.force[..., :-1]
    spin = np.einsum("kl,lnm->knm", motion.rates, angle) + motion.spin_past
    spin_rate = np.einsum("kl,lnm->knm", motion.rates, spin) + motion.spin_rate_past
    slopes = {
        X: c,
        Y: s,
        FX: p * s + zeta * ((gamma * c**2 + s**2) * u + (gamma - 1) * s * c * v) + rho * ax,
        FY: -p * c + zeta * ((gamma - 1) * s * c * u + (gamma * s**2 + c**2) * v) + rho * ay,
        MOMENT: fx * s - fy * c + rho * LOADS[load].rotary_inertia * spin_rate,
        THETA: fields.moment[..., :-1] / b,
    }
    got = {X: fields.position[0], Y: fields.position[1], FX: fields.force[0], FY: fields.force[1]}
    got |= {MOMENT: fields.moment, THETA: fields.theta}
    for name, slope in slopes.items():
        expected = unknowns[..., name, None] + integrals(equations, slope)
        np.testing.assert_allclose(got[name], expected, atol=1e-12, err_msg=f"unknown {name}")


def test_velocity_and_acceleration_follow_from_the_positions():
    equations = equations_of("two", "drag")
    unknowns, motion = random_loop(equations, 3), random_motion(equations, 3)
    fields = equations.fields(unknowns, motion)
    for component in range(2):
        velocity = np.einsum("kl,lnm->knm", motion.rates, fields.position[component]) + motion.velocity_past[component]
        acceleration = np.einsum("kl,lnm->knm", motion.rates, velocity) + motion.acceleration_past[component]
        np.testing.assert_allclose(fields.velocity[component], velocity, atol=1e-12)
        np.testing.assert_allclose(fields.acceleration[component], acceleration, atol=1e-11)


def test_the_residual_is_what_the_cells_miss():
    """The next node's values, round the loop, θ growing by 2π; then the collocation of θ."""
    equations = equations_of("three", "drag")
    unknowns, motion = random_loop(equations, 2), random_motion(equations, 2)
    fields = equations.fields(unknowns, motion)
    residual = equations.residual(unknowns, fields)
    following = np.roll(unknowns[..., :NODAL], -1, axis=1)
    following[:, -1, THETA] += 2 * pi
    ends = {X: fields.position[0], Y: fields.position[1], THETA: fields.theta, MOMENT: fields.moment}
    ends |= {FX: fields.force[0], FY: fields.force[1]}
    for name, values in ends.items():
        np.testing.assert_allclose(residual[..., name], values[..., -1] - following[..., name], atol=1e-12)
    np.testing.assert_allclose(residual[..., NODAL:], fields.theta[..., :-1] - unknowns[..., NODAL:], atol=1e-12)


def differenced(function, at, direction, step=1e-3):
    """Directional derivative by central differences, extrapolated twice: error of order step⁶."""
    first, second, third = (
        (function(at + h * direction) - function(at - h * direction)) / (2 * h) for h in (step, step / 2, step / 4)
    )
    once, twice = (4 * second - first) / 3, (4 * third - second) / 3
    return (16 * twice - once) / 15


def linear_response(equations, fields, rate, correction):
    """What the linearisation says that `residual` changes by."""
    parts = equations.linearise(
        fields.cosine[0], fields.sine[0], fields.force[:, 0, :, :-1], fields.velocity[:, 0, :, :-1]
    )
    response = parts[0] + rate**2 * parts[1] + (rate * parts[2] if len(parts) == 3 else 0)
    change = np.einsum("nij,nj->ni", response, correction)
    change[:, NODAL:] -= correction[:, NODAL:]
    change[:, :NODAL] -= np.roll(correction[:, :NODAL], -1, axis=0)
    return change


@CASES
@pytest.mark.parametrize("m", [1, 3])
@given(seed=st.integers(0, 10**6), rate=st.sampled_from([0.0, 0.7, 3.0]))
@settings(max_examples=5)
def test_the_linearisation_is_the_derivative_of_the_residual(rod, load, m, seed, rate):
    equations = equations_of(rod, load, m)
    motion = random_motion(equations, seed=seed)._replace(rates=np.array([[rate]]))
    unknowns, direction = random_loop(equations, seed=seed), random_loop(equations, seed=seed + 1)

    def residual(values):
        return equations.residual(values, equations.fields(values, motion))[0]

    expected = differenced(residual, unknowns, direction)
    got = linear_response(equations, equations.fields(unknowns, motion), rate, direction[0])
    np.testing.assert_allclose(got, expected, atol=1e-7 * np.abs(expected).max())


@pytest.mark.parametrize("load", LOADS)
def test_drag_has_a_part_of_its_own_only_if_there_is_any(load):
    equations = equations_of("two", load)
    fields = equations.fields(random_loop(equations), random_motion(equations))
    parts = equations.linearise(
        fields.cosine[0], fields.sine[0], fields.force[:, 0, :, :-1], fields.velocity[:, 0, :, :-1]
    )
    assert len(parts) == (3 if LOADS[load].zeta_perp else 2)


def test_an_extra_force_acts_where_the_pressure_does():
    """The pressure itself, added as a force density, changes the residual as a change of p does."""
    weak, strong = (BoxEquations(equations_of("three", "drag").mesh, gauss_rule(3), Load(p, 1.7, 0.3)) for p in (2, 5))
    unknowns, motion = random_loop(weak), random_motion(weak)
    before, after = (e.residual(unknowns, e.fields(unknowns, motion))[0] for e in (weak, strong))
    angle = unknowns[0, :, NODAL:]
    density = 3.0 * np.stack([np.sin(angle), -np.cos(angle)])
    np.testing.assert_allclose(weak.load_response(np.cos(angle), np.sin(angle), density), after - before, atol=1e-11)


def test_displacement_is_the_derivative_of_the_position():
    equations = equations_of("three", "pressure")
    unknowns, direction = random_loop(equations), random_loop(equations, seed=5)
    expected = differenced(lambda values: equations.shape(values)[1][:, 0], unknowns, direction)
    fields = equations.fields(unknowns, None)
    got = equations.displacement(fields.cosine[0], fields.sine[0], direction[0])
    np.testing.assert_allclose(got, expected, atol=1e-8)


@pytest.mark.parametrize("spin", [0.0, 1.3])
@pytest.mark.parametrize("p", [-3.0, 0.0, 4.0])
def test_a_circle_balances_pressure_and_spin_by_its_axial_force(p, spin):
    """F·t = ρ spin² - p all round; the defect of a stage is of order h^(m+1)."""
    defects = []
    for cells in (8, 16):
        equations = BoxEquations(Mesh.on(Rod((Segment(1.0, 1.0, 2.0),)), (cells,)), gauss_rule(2), Load(p))
        s, axial = equations.mesh.edges[:-1], 2.0 * spin**2 - p
        columns = (np.sin(s), -np.cos(s), s, np.ones(cells), axial * np.cos(s), axial * np.sin(s))
        angles = equations.mesh.points(equations.rule.points)
        unknowns = np.concatenate([np.stack(columns, 1), angles], axis=1)[None]
        position = equations.shape(unknowns)[1]
        inward = Motion(np.zeros((1, 1)), np.zeros_like(position), -(spin**2) * position)
        residual = equations.residual(unknowns, equations.fields(unknowns, inward))
        defects.append(np.abs(residual).max())
    assert defects[1] < 1e-2
    assert np.log2(defects[0] / defects[1]) > 2.8
