"""When a damped loop has come to rest."""

import numpy as np

from rodloop_cli.errors import ConvergenceError
from rodloop_cli.march.state import State
from rodloop_cli.numerics.gauss import Array
from rodloop_cli.physics.closure import Closure
from rodloop_cli.statics import relax

LEAST_DISTANCE = 1e-9
"""No equilibrium is known better than that."""


class RestWatch:
    """Tells when a damped loop has come to rest at an equilibrium.

    Slowness alone is no proof: a strongly damped loop creeps, and one that is about to buckle has hardly begun to move.
    Once it is slow, the equilibrium nearest to its shape is found by the static solver; at rest means within ``tol``
    of it, relative to the departure. Asked again only after the loop has slowed down tenfold, or has been fast.

    slow: the speed below which it is asked.
    """

    def __init__(self, tol: float) -> None:
        self._tol = tol
        self.slow = tol

    def settled(self, state: State, departure: float) -> bool:
        """Whether this state, so far from where the loop began (at most 1), is at rest."""
        speed = float(np.abs(state.velocity).max())
        if speed > self.slow:
            self.slow = self._tol if speed > self._tol else self.slow
            return False
        self.slow = speed / 10
        try:
            equilibrium = relax(state.equations, state.unknowns)
        except ConvergenceError:
            return False
        return distance(state, equilibrium) < max(LEAST_DISTANCE, self._tol * departure)


def distance(state: State, unknowns: Array) -> float:
    """Largest distance between two positions of the loop on one mesh, their centres together."""
    position = state.equations.shape(unknowns[None])[1][:, 0]
    closure = Closure(state.equations)
    shift = closure.centre(position) - closure.centre(state.position)
    return float(np.abs(position - shift[:, None, None] - state.position).max())
