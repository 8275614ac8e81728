"""Physical units of a case, read with and without pint, and where they show."""

import sys

import pytest
from matplotlib.figure import Figure

from rodloop_cli import Case, simulate
from rodloop_cli.case import parse_case
from rodloop_cli.errors import CaseError
from rodloop_cli.plot import draw_forces, milliseconds, style

PLAIN = "p: 4\nt_end: 0.1\nscales: {R: 0.045, B1: 2.27e-6, rho_A1: 9.64e-5}\n"
WORDS = "p: 4\nt_end: 0.1\nscales: {R: 45 mm, B1: 2.27e-6 N m^2, rho_A1: 96.4 mg/m}\n"


def test_units_of_time_force_and_load_follow_equation_8():
    scales = parse_case(PLAIN).scales
    assert scales.time == pytest.approx(0.0131963, rel=1e-5)
    assert scales.force == pytest.approx(2.27e-6 / 0.045**2)
    assert scales.pressure == pytest.approx(2.27e-6 / 0.045**3)


def test_text_with_units_is_the_same_case():
    pytest.importorskip("pint")
    words, plain = parse_case(WORDS).scales, parse_case(PLAIN).scales
    assert (words.R, words.B1, words.rho_A1) == pytest.approx((plain.R, plain.B1, plain.rho_A1))


def test_the_resolved_case_holds_si_numbers_and_loads_again():
    case = parse_case(PLAIN)
    assert parse_case(case.to_yaml()) == case


@pytest.mark.parametrize(
    ("value", "said"),
    [("45 s", "must have the dimension of m"), ("a lot", "must be a number and a unit"), ("-3 mm", "must be at least")],
)
def test_a_wrong_quantity_is_one_line(value, said):
    pytest.importorskip("pint")
    with pytest.raises(CaseError, match=said) as refused:
        parse_case(WORDS.replace("45 mm", value))
    assert str(refused.value).count("\n") == 0


def test_without_pint_text_is_refused_with_the_remedy(monkeypatch):
    monkeypatch.setitem(sys.modules, "pint", None)
    with pytest.raises(CaseError, match="pint"):
        parse_case(WORDS)
    assert parse_case(PLAIN).scales is not None


def test_a_scale_left_out_is_told():
    with pytest.raises(CaseError, match=r"scales\.rho_A1: is required"):
        parse_case("p: 4\nt_end: 0.1\nscales: {R: 0.045, B1: 2.27e-6}\n")


def test_forces_and_times_get_a_second_axis_only_with_scales():
    with style():
        for case, axes in ((parse_case(PLAIN), 1), (Case(p=4, t_end=0.1), 0)):
            run = simulate(case)
            upper, lower = Figure().subplots(2)
            draw_forces(upper, run, "axial")
            milliseconds(lower, run)
            assert (len(upper.child_axes), len(lower.child_axes)) == (axes, axes)


def test_rotary_inertia_reaches_the_motion():
    still, turning = (simulate(Case(p=3.8, stiffness_ratio=5, t_end=0.5, rotary_inertia=i)) for i in (0.0, 1e-2))
    assert 1e-3 < abs(still["x"] - turning["x"]).max() < 0.1
