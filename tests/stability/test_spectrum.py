"""The spectrum of small motions, against closed forms, references and the equations themselves."""

import numpy as np
import pytest

from rodloop_cli.numerics.roots import bracketed_root
from rodloop_cli.physics.boxes import BoxEquations
from rodloop_cli.physics.equations import NODAL, Load
from rodloop_cli.physics.rod import Rod, Segment
from rodloop_cli.stability.compliance import Compliance
from rodloop_cli.stability.modes import ModeSearch, base_state, modes_along, modes_at
from rodloop_cli.stability.spectrum import eigenmotions, shift_for
from rodloop_cli.statics.branch import to_load
from rodloop_cli.statics.loaded import at_zero_load, loaded_circle

N = np.arange(2, 13)


def two(ratio, density=1.0, k=0.5):
    return Rod((Segment(k), Segment(1 - k, ratio, density)))


def squares(modes):
    return np.array([mode.rate**2 for mode in modes]).real


@pytest.mark.parametrize("p", [-5.0, 0.0, 2.0, 3.0, 16.0, 128.0, 150.0])
def test_the_circle_follows_equation_17(p):
    expected = N**2 * (N**2 - 1) / (N**2 + 1) * (p + 1 - N**2)
    found = np.sort(squares(modes_at(Rod(), Load(p), ModeSearch(count=24)).modes))[::-1]
    both = np.sort(np.repeat(expected, 2))[::-1]
    assert found[: len(both)] == pytest.approx(both, rel=1e-6, abs=1e-6)


def test_each_mode_of_the_circle_has_its_number_of_lobes():
    modes = modes_at(Rod(), Load(16.0), ModeSearch(count=16)).modes
    assert [mode.lobes for mode in modes] == [3, 3, 2, 2, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 9]


@pytest.mark.parametrize("p", [0.0, 4.3, 16.0])
def test_drag_on_the_circle(p):
    """(n² + 1) λ² + ζ (n² + γ) λ = n² (n² - 1)(p + 1 - n²): Eq. (17) with drag, normal and tangential motion being n :
    1.
    """
    zeta, gamma = 1.2, 0.3
    found = [mode.rate for mode in modes_at(Rod(), Load(p, zeta, gamma), ModeSearch(count=20)).modes]
    for n in N[:7]:
        roots = np.roots([n**2 + 1, zeta * (n**2 + gamma), -(n**2) * (n**2 - 1) * (p + 1 - n**2)])
        root = max(roots, key=lambda root: (root.real, root.imag))
        assert sum(abs(rate - root) < 1e-6 * abs(root) for rate in found) == 2


@pytest.mark.parametrize(
    ("cells", "points", "tolerance"), [(20, 3, 6e-4), (24, 8, 4e-3)], ids=["as in the reference", "converged"]
)
def test_the_six_growing_modes_of_density_ratio_5(cells, points, tolerance):
    """Reference: the box pencil on 20 cells of 3 points, which is converged to 4e-3 only."""
    loop = loaded_circle(two(1.0, 5.0), 16.0, cells, points)
    reference = [39.941, 36.696, 12.754, 10.060, 4.574, 4.516]
    assert squares(eigenmotions(loop, 6)) == pytest.approx(reference, abs=tolerance)


def test_density_ratio_5_does_not_depend_on_the_mesh():
    found = [squares(eigenmotions(loaded_circle(two(1.0, 5.0), 16.0, cells, 8), 6)) for cells in (12, 24)]
    assert found[0] == pytest.approx(found[1], rel=1e-9)
    assert found[1] == pytest.approx([39.9411389, 36.6967925, 12.7549809, 10.0604598, 4.5778715, 4.5198636], abs=1e-6)


def test_the_matrix_is_symmetric_and_knows_the_rigid_motions():
    loop = to_load(at_zero_load(two(5.0, 3.0, 0.3), 12), 3.8)
    compliance = Compliance(loop, 2.0)
    n, size = loop.unknowns.shape
    rows, columns = loop.position_rows, compliance.corrections.reshape(n, size, -1)
    moved = np.concatenate([np.matmul(rows[c], columns).reshape(-1, columns.shape[-1]) for c in range(2)])
    raw = compliance.root_mass[:, None] * moved * (compliance.density / compliance.root_mass)
    scale = np.abs(raw).max()
    assert np.abs(raw - raw.T).max() < 1e-12 * scale
    assert np.abs(raw @ compliance.neutral + compliance.neutral / 2.0).max() < 1e-11 * scale


@pytest.mark.parametrize("zeta", [0.0, 1.2])
@pytest.mark.parametrize("p", [3.8, 9.0])
def test_every_motion_solves_the_linearised_boxes(p, zeta):
    """K0 x = λ L2 x + λ² L1 x with the parts of the time-stepping Jacobian."""
    loop = base_state(two(5.0, 3.0, 0.3), p, 12)
    mesh, rule = loop.equations.mesh, loop.equations.rule
    still = np.zeros_like(loop.tangent)
    force = loop.fields.force[:, 0, :, :-1]
    parts = BoxEquations(mesh, rule, Load(p, zeta, 0.4)).linearise(*loop.tangent, force, still)
    for motion in eigenmotions(loop, 6, Load(p, zeta, 0.4)):
        response = parts[0] + motion.rate**2 * parts[1] + (motion.rate * parts[2] if zeta else 0)
        x = motion.unknowns
        ahead = x.copy()
        ahead[:, :NODAL] = np.roll(x[:, :NODAL], -1, axis=0)
        missed = ahead - np.einsum("nij,nj->ni", response, x)
        assert np.abs(missed).max() < 1e-8 * np.abs(x).max()


@pytest.mark.parametrize("ratio", [5.0, 12.8])
def test_contrast_keeps_the_loop_stable_to_ten(ratio):
    for at in modes_along(two(ratio), Load(0.0), (0.0, 3.0, 6.0, 10.0), ModeSearch(count=4, cells=12)):
        assert squares(at.modes).max() < -5


def test_the_imperfect_bifurcation_of_ratio_1_02():
    at = list(modes_along(two(1.02), Load(0.0), (0.0, 3.0), ModeSearch(count=2, cells=12)))
    assert [squares(a.modes).max() for a in at] == pytest.approx([-7.27, -0.07], abs=0.04)


def test_the_shift_lies_above_the_spectrum():
    for p in (0.0, 16.0, 128.0):
        loop = loaded_circle(two(1.0, 0.2), p, 16)
        assert shift_for(loop) > squares(eigenmotions(loop, 1))[0]


def test_a_motion_that_grows_is_found_where_the_square_crosses_zero():
    root = bracketed_root(lambda p: squares(eigenmotions(loaded_circle(Rod(), p, 12), 1))[0], 2.0, 5.0, 1e-9)
    assert root == pytest.approx(3.0, abs=1e-8)
