import numpy as np
import pytest

from rodloop_cli.numerics.interpolation import interpolation, series
from rodloop_cli.numerics.radau import radau_iia

ENDS = np.array([0.0, 1e-9, 0.3, 0.999, 1.0])


@pytest.mark.parametrize("stages", [1, 3, 5, 7])
def test_polynomials_and_their_integrals_are_exact(stages):
    nodes = np.array([0.0, *radau_iia(stages).nodes])
    through = interpolation(tuple(nodes.tolist()))
    values, integrals = (
        series(ENDS, len(coefficients)) @ coefficients for coefficients in (through.values, through.integrals)
    )
    for power in range(stages + 1):
        np.testing.assert_allclose(values @ nodes**power, ENDS**power, rtol=0, atol=1e-13)
        np.testing.assert_allclose(integrals @ nodes**power, ENDS ** (power + 1) / (power + 1), rtol=0, atol=1e-13)


def test_a_set_of_nodes_is_prepared_once():
    assert interpolation((0.0, 0.5, 1.0)) is interpolation((0.0, 0.5, 1.0))
