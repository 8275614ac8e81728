"""A guess of what a member costs, to start the longest ones first. Only the order of the guesses matters."""

from __future__ import annotations

from math import log10, sqrt

from rodloop_cli.case import Case


def guessed_cost(case: Case) -> float:
    """Steps times cells, in units of no meaning.

    A fixed step says it all. With error control a deep buckled shape needs cells like the number of its waves, which is
    that of the mode that grows fastest, sqrt((1 + |p|)/2); the steps to a crossing hardly depend on the load.
    """
    if case.scheme == "bdf2":
        assert case.N is not None
        assert case.dt is not None
        return case.N * case.t_end / case.dt
    assert case.tol is not None
    cells = case.N or sqrt(1 + abs(case.p)) * len(case.segments)
    steps = 1 + log10(1 / case.tol)
    runs_on = "crossing" not in case.stop_at
    return cells * steps * (1 + case.t_end * (1 + abs(case.p)) ** 0.75 if runs_on else 1 + min(case.t_end, 1.0))
