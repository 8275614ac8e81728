"""Rules that tie several values of a case together.

Each rule is a generator over ``given``: the keys the user wrote, with plain values (numbers, text, lists,
mappings) that are valid one by one. A key whose own value is broken is there as None: given, but not known.
So rules run even when other keys are broken, and one look at the messages is enough.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from rodloop_cli.case.fault import Fault

Given = Mapping[str, Any]

#: Fractions add up in floating point; a sum further from 1 than this is a mistake, not round-off.
FRACTION_TOLERANCE = 1e-9
#: Larger radial perturbations fold the shape over its own centre.
AMPLITUDE_SUM_LIMIT = 0.5
#: The number of stored values (times x points) of one variable: 80 MB each, 1.5 GB a file.
STORED_LIMIT = 10_000_000
#: Fixed steps in one run: days of computing.
STEP_LIMIT = 10_000_000

RATIO_KEYS = ("stiffness_ratio", "density_ratio", "k")
DEFAULT_N = 300
DEFAULT_DT = 1e-3
DEFAULT_SNAPSHOTS = 200
DEFAULT_POINTS = 200


def conflicts(given: Given) -> Iterator[Fault]:
    """Everything wrong with the values of a case taken together."""
    for rule in _RULES:
        yield from rule(given)


def _list(given: Given, key: str) -> Sequence[Any]:
    return given.get(key) or ()


def _lists_are_not_empty(given: Given) -> Iterator[Fault]:
    for key in ("segments", "snapshot_times"):
        value = given.get(key)
        if value is not None and len(value) == 0:
            yield Fault((key,), "must not be empty; remove the key", [])


def _segments_replace_ratios(given: Given) -> Iterator[Fault]:
    if "segments" not in given:
        return
    for key in RATIO_KEYS:
        if key in given:
            yield Fault(
                (key,),
                "cannot be combined with segments; remove one of the two",
                given[key],
            )


def _fractions_make_a_loop(given: Given) -> Iterator[Fault]:
    segments = _list(given, "segments")
    total = float(sum(segment["fraction"] for segment in segments))
    if segments and abs(total - 1) > FRACTION_TOLERANCE:
        yield Fault(("segments",), f"fractions must sum to 1 within {FRACTION_TOLERANCE:g}", total)


def _first_segment_is_the_unit(given: Given) -> Iterator[Fault]:
    first: Mapping[str, Any] = next(iter(_list(given, "segments")), {})
    for key in ("stiffness", "density"):
        value = first.get(key, 1)
        if value != 1:
            what = f"must be 1 in the first segment, the unit of the others; divide every {key} by {value:g}"
            yield Fault(("segments", 0, key), what, value)


def _amplitudes_are_small(given: Given) -> Iterator[Fault]:
    total = float(sum(abs(item.get("random", item)["amplitude"]) for item in _list(given, "perturbation")))
    if total >= AMPLITUDE_SUM_LIMIT:
        yield Fault(("perturbation",), f"amplitudes must sum to less than {AMPLITUDE_SUM_LIMIT:g}", total)


def _modes_are_ordered(given: Given) -> Iterator[Fault]:
    for index, item in enumerate(_list(given, "perturbation")):
        first, last = item["random"]["modes"] if "random" in item else (0, 0)
        if first > last:
            loc = ("perturbation", index, "random", "modes")
            yield Fault(loc, "the first mode must not exceed the last", [first, last])


def _modes_are_resolved(given: Given) -> Iterator[Fault]:
    cells = given.get("N", DEFAULT_N if given.get("scheme") == "bdf2" else None)
    for index, item in enumerate(_list(given, "perturbation")):
        inner, mode = (
            (("random", "modes"), item["random"]["modes"][1]) if "random" in item else (("mode",), item["mode"])
        )
        if cells is not None and 2 * mode > cells:
            yield Fault(("perturbation", index, *inner), f"needs N of at least {2 * mode} (N is {cells})", mode)


def _every_segment_has_a_cell(given: Given) -> Iterator[Fault]:
    count, cells = len(_list(given, "segments")), given.get("N")
    if cells is not None and cells < count:
        yield Fault(("N",), f"must be at least the number of segments, {count}", cells)


def _scheme_uses_its_keys(given: Given) -> Iterator[Fault]:
    if given.get("scheme") == "bdf2" and "tol" in given:
        yield Fault(("tol",), "is not used by scheme bdf2, whose accuracy N and dt set; remove it", given["tol"])


def _steps_are_bounded(given: Given) -> Iterator[Fault]:
    is_fixed = given.get("scheme") == "bdf2"
    dt, t_end = given.get("dt", DEFAULT_DT if is_fixed else None), given.get("t_end")
    if dt is None or t_end is None:
        return
    blamed = "dt" if "dt" in given else "t_end"
    if is_fixed and dt > t_end:
        yield Fault((blamed,), f"the step dt = {dt:g} must not exceed t_end = {t_end:g}", given[blamed])
    if t_end / dt > STEP_LIMIT:
        what = f"t_end = {t_end:g} in steps of dt = {dt:g} is more than {STEP_LIMIT} steps"
        yield Fault((blamed,), what, given[blamed])


def _times_are_said_once(given: Given) -> Iterator[Fault]:
    if "snapshots" in given and "snapshot_times" in given:
        what = "cannot be combined with snapshot_times; remove one of the two"
        yield Fault(("snapshots",), what, given["snapshots"])


def _times_increase(given: Given) -> Iterator[Fault]:
    for index, (before, after) in enumerate(pairwise(_list(given, "snapshot_times"))):
        if after <= before:
            yield Fault(("snapshot_times", index + 1), f"must be greater than the time before it, {before:g}", after)


def _times_are_reached(given: Given) -> Iterator[Fault]:
    t_end = given.get("t_end")
    for index, time in enumerate(_list(given, "snapshot_times")):
        if t_end is not None and time > t_end:
            yield Fault(("snapshot_times", index), f"must not exceed t_end = {t_end:g}", time)


def _file_is_bounded(given: Given) -> Iterator[Fault]:
    times = given.get("snapshots", len(_list(given, "snapshot_times")) or DEFAULT_SNAPSHOTS)
    points = given.get("output_points", DEFAULT_POINTS)
    if times is not None and points is not None and times * points > STORED_LIMIT:
        blamed = "output_points" if "output_points" in given else "snapshots"
        what = f"{times} stored times of {points} points are more than {STORED_LIMIT} values a variable"
        yield Fault((blamed,), what, given[blamed])


_RULES: tuple[Callable[[Given], Iterator[Fault]], ...] = (
    _lists_are_not_empty,
    _segments_replace_ratios,
    _fractions_make_a_loop,
    _first_segment_is_the_unit,
    _amplitudes_are_small,
    _modes_are_ordered,
    _modes_are_resolved,
    _every_segment_has_a_cell,
    _scheme_uses_its_keys,
    _steps_are_bounded,
    _times_are_said_once,
    _times_increase,
    _times_are_reached,
    _file_is_bounded,
)
