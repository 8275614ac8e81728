"""Case files broken byte by byte."""

import pytest

from scripts.stress.inputs import HOSTILE, SLOW, case_files, fuzz


def test_broken_bytes_are_refused_in_words_or_mean_a_case():
    tally = fuzz(case_files(), 300)
    assert tally.wrongly_accepted == []
    assert tally.unexplained == []
    assert tally.slowest < SLOW


@pytest.mark.parametrize("size", [10, 100_000])
@pytest.mark.parametrize(
    "unit", [b"[", b"{a: ", b"- ", b"a: &a\n", b"k%d: 1\n", b"'", b"# \n", b"\xff", b"\x00", *HOSTILE[:2]]
)
def test_the_same_again_and_again_takes_bounded_time(unit, size):
    tally = fuzz([unit * size], 1)
    assert tally.unexplained == []
    assert tally.slowest < SLOW
