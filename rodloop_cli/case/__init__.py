"""The case file: YAML text in, a checked `Case` out, or one plain line for each thing wrong with it.

`load_case` and `parse_case` are all that most need. A sweep file reads its text with `open_document`, checks it
with `validated`, sets values with `with_value` and makes each member a case with `case_from`.
"""

from rodloop_cli.case.fault import Fault
from rodloop_cli.case.load import case_from, load_case, open_document, parse_case
from rodloop_cli.case.model import (
    Case,
    ModePerturbation,
    Perturbation,
    RandomModes,
    RandomPerturbation,
    Segment,
)
from rodloop_cli.case.override import with_overrides, with_value
from rodloop_cli.case.report import validated
from rodloop_cli.case.text import Document, read_document

__all__ = [
    "Case",
    "Document",
    "Fault",
    "ModePerturbation",
    "Perturbation",
    "RandomModes",
    "RandomPerturbation",
    "Segment",
    "case_from",
    "load_case",
    "open_document",
    "parse_case",
    "read_document",
    "validated",
    "with_overrides",
    "with_value",
]
