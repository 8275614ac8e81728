"""What a result is called."""

import pytest

from rodloop_cli.case import parse_case
from rodloop_cli.case.title import title_of
from rodloop_cli.simulation import Run


@pytest.mark.parametrize(
    ("more", "title"),
    [
        ("", "Elastic loop, p = 3.8"),
        ("stiffness_ratio: 5\n", "Elastic loop, p = 3.8, stiffness ratio 5"),
        (
            "stiffness_ratio: 5\ndensity_ratio: 0.5\nk: 0.25\n",
            "Elastic loop, p = 3.8, stiffness ratio 5, density ratio 0.5, k = 0.25",
        ),
        ("zeta_perp: 2\nk: 0.25\n", "Elastic loop, p = 3.8, drag 2"),
        (
            "segments: [{fraction: 0.5}, {fraction: 0.2, stiffness: 3}, {fraction: 0.3}]\n",
            "Elastic loop, p = 3.8, 3 segments",
        ),
        ("title: Föppl's loop\nstiffness_ratio: 5\n", "Föppl's loop"),
        ("title: ' '\n", "Elastic loop, p = 3.8"),
    ],
)
def test_a_case_without_a_title_is_called_by_what_sets_it_apart(more, title):
    assert title_of(parse_case("p: 3.8\nt_end: 1\n" + more)) == title


def test_a_result_has_a_title_and_the_case_in_it_has_none():
    attributes = Run.of(parse_case("p: 3.8\nt_end: 1\nN: 8\n")).attributes
    assert attributes["title"] == "Elastic loop, p = 3.8"
    assert parse_case(attributes["case"]).title == ""
