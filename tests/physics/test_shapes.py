import numpy as np
import pytest

from rodloop_cli.numerics.gauss import gauss_rule
from rodloop_cli.physics.rod import LENGTH, Mesh, Rod, Segment
from rodloop_cli.physics.shapes import Wave, circle, displacement, perturbed
from rodloop_cli.statics import as_shape, unloaded

S = np.linspace(0.05, LENGTH - 0.05, 400)
HALVES = Rod((Segment(0.5), Segment(0.5, 5.0)))
WAVES = (Wave(2, 0.05), Wave(5, 0.08, 1.1))


@pytest.mark.parametrize("rod", [Rod(), HALVES], ids=["circle", "halves"])
def test_the_curvature_is_the_slope_of_the_angle(rod):
    rule, mesh = gauss_rule(8), Mesh.on(HALVES, (8, 8))
    base = as_shape(mesh, rule, unloaded(mesh, rule)) if rod is HALVES else circle()
    shape, step = perturbed(base, WAVES, rod), 1e-5
    inside = S[np.abs(S - LENGTH / 2) > 2 * step]
    slope = (shape.along(inside + step)[0] - shape.along(inside - step)[0]) / (2 * step)
    np.testing.assert_allclose(slope, shape.along(inside)[1], atol=1e-5)


def test_a_perturbed_circle_is_the_displaced_one_scaled():
    """Positions from the angle agree with (1 + δ)(sin φ, -cos φ) at the points that have the same tangent."""
    shape, rule = perturbed(circle(), WAVES, Rod()), gauss_rule(10)
    mesh = Mesh.on(Rod(), (60,))
    theta = shape.along(mesh.points(rule.points))[0]
    tangent = np.stack([np.cos(theta), np.sin(theta)])
    nodes = np.cumsum((tangent @ rule.weights) * mesh.lengths, axis=1)
    np.testing.assert_allclose(nodes[:, -1], 0.0, atol=1e-13)
    phi = np.linspace(0, LENGTH, 20001)
    outline = (1 + displacement(WAVES, phi)) * np.stack([np.sin(phi), -np.cos(phi)])
    pieces = np.hypot(*np.diff(outline, axis=1))
    along = np.concatenate([[0.0], np.cumsum(pieces)])
    scale = LENGTH / along[-1]
    expected = np.stack([np.interp(mesh.edges[1:], along * scale, scale * part) for part in outline])
    np.testing.assert_allclose(nodes - nodes[:, -1:], expected - expected[:, -1:], atol=1e-6)
