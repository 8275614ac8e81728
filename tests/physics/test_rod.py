"""The rod and its mesh."""

import pytest

from rodloop_cli.physics.rod import Rod, Segment, cells_by_length


@pytest.mark.parametrize(
    ("fractions", "cells", "expected"),
    [
        ((1.0,), 300, (300,)),
        ((0.5, 0.5), 301, (151, 150)),
        ((0.1, 0.7, 0.2), 300, (30, 210, 60)),
        ((1 / 3, 1 / 3, 1 / 3), 100, (34, 33, 33)),
        ((0.001, 0.999), 40, (1, 39)),
        ((1.0,), 1, (2,)),
    ],
)
def test_cells_are_shared_out_to_the_last(fractions, cells, expected):
    assert cells_by_length(Rod(tuple(Segment(fraction) for fraction in fractions)), cells) == expected


def test_every_segment_has_a_cell():
    assert cells_by_length(Rod((Segment(0.01), Segment(0.98), Segment(0.01))), 4) == (1, 3, 1)
