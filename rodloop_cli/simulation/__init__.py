"""From a case to its result: the only place that composes all parts.

`start` builds the state at t = 0, `run` follows the steps, `record` makes rows of them, `account` adds up energies,
`events` finds what happens between rows, `rest` when the motion has ended, `amplification` the waves that grow out of
errors; `resume` takes a run up again, `summary` says what it found and what it cost.
"""

from typing import TYPE_CHECKING

from rodloop_cli.case import Case
from rodloop_cli.simulation.run import Progress, Run
from rodloop_cli.simulation.summary import Summary

if TYPE_CHECKING:
    import xarray

__all__ = ["Progress", "Run", "Summary", "simulate"]


def simulate(case: Case, progress: Progress | None = None) -> "xarray.Dataset":
    """Run a case in memory; the Dataset equals what `open_run` gives for the file of the same run.

    Raises ConvergenceError if the solver gives up.
    """
    from rodloop_cli.dataset.memory import MemoryRows  # noqa: PLC0415  xarray takes a second to import

    run = Run.of(case)
    rows = MemoryRows(s=run.recorder.s, segment=run.recorder.segment, attributes=run.attributes)
    run.into(rows, progress)
    return rows.dataset()
