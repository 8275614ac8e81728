"""Result files: what is in them, how they are written while a run goes on, how they are read."""

from rodloop_cli.dataset.memory import MemoryRows
from rodloop_cli.dataset.provenance import outcome_attributes, run_attributes
from rodloop_cli.dataset.reader import open_run
from rodloop_cli.dataset.rows import Row, RowSink
from rodloop_cli.dataset.writer import RunWriter

__all__ = ["MemoryRows", "Row", "RowSink", "RunWriter", "open_run", "outcome_attributes", "run_attributes"]
