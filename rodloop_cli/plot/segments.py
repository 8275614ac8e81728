"""The segments of the loop as drawings know them: where each lies, of what it is made, and its colour."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import xarray as xr
from matplotlib.colors import to_hex, to_rgb

from rodloop_cli.case import Case, parse_case
from rodloop_cli.errors import CaseError
from rodloop_cli.plot.data import LENGTH, Array, closed_arclength, place, segment_numbers

ORANGE, BLUE, PURPLE = "#e8820c", "#1f6fb4", "#7b3fa0"
GREEN, SKY, PINK = "#1b8a5a", "#4fb3e8", "#d46aa5"
SPARE = (BLUE, PURPLE, GREEN, SKY, PINK, "#a0522d", "#b59a00", "#14747a")
MOST_NAMED = 4

LIGHTEST, DARKEST = 0.6, 0.45
"""Of the shades over time: how much white the first frame holds, how much black the last."""

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Segment:
    """`start`, `end`: arclengths over R; `stiffness`, `density`: over segment 1's, None if the file does not tell."""

    number: int
    start: float
    end: float
    stiffness: float | None
    density: float | None
    colour: str

    @property
    def middle(self) -> float:
        return (self.start + self.end) / 2

    @property
    def material(self) -> str:
        """What differs from segment 1, as mathtext; empty if nothing does."""
        ratios = [("B", self.stiffness), (r"\rho", self.density)]
        told = [(symbol, ratio) for symbol, ratio in ratios if ratio is not None and ratio != 1]
        return ", ".join(rf"${symbol}_{{{self.number}}}/{symbol}_1 = {ratio:.4g}$" for symbol, ratio in told)

    def shade(self, fraction: float) -> str:
        """Light at 0, the colour itself half-way, dark at 1."""
        return to_hex(self.shades(np.array([fraction]))[0].tolist())

    def shades(self, fractions: Array) -> Array:
        """RGB (n, 3), as `shade`."""
        base = np.array(to_rgb(self.colour))
        light, dark = LIGHTEST + (1 - LIGHTEST) * base, (1 - DARKEST) * base
        columns = [np.interp(fractions, [0.0, 0.5, 1.0], stops) for stops in zip(light, base, dark, strict=True)]
        return np.stack(columns, axis=-1)


def segments(dataset: xr.Dataset) -> tuple[Segment, ...]:
    """All segments of a result, from the case that it carries."""
    numbers = segment_numbers(dataset)
    found = _from_case(str(dataset.attrs.get("case", "")))
    if found and found[-1].number >= numbers.max():
        return found
    _log.warning("%sthe case inside cannot be read; segments are drawn without their materials", place(dataset))
    return tuple(_from_points(numbers, closed_arclength(dataset)))


def pieces(dataset: xr.Dataset) -> Iterator[tuple[Segment, slice]]:
    """Each segment that has points, with its points; `slice.stop` is the first point of the next one."""
    numbers = segment_numbers(dataset)
    known = segments(dataset)
    for number in np.unique(numbers):
        found = np.flatnonzero(numbers == number)
        yield known[number - 1], slice(int(found[0]), int(found[-1]) + 1)


def materials(dataset: xr.Dataset) -> dict[str, list[Segment]]:
    """The segments of each colour: those of one material share it."""
    grouped: dict[str, list[Segment]] = {}
    for segment in segments(dataset):
        grouped.setdefault(segment.colour, []).append(segment)
    return grouped


def name(members: list[Segment]) -> str:
    """``segment 2: B2/B1 = 5`` for segments of one material."""
    numbers = ", ".join(str(member.number) for member in members[:MOST_NAMED]) + ", …" * (len(members) > MOST_NAMED)
    noun = "segment" if len(members) == 1 else "segments"
    material = members[0].material
    return f"{noun} {numbers}" + (f": {material}" if material else "")


@lru_cache(maxsize=4)
def _from_case(text: str) -> tuple[Segment, ...]:
    try:
        case = parse_case(text)
    except CaseError:  # written by another version, or tampered with
        return ()
    return tuple(_of(case))


def _of(case: Case) -> Iterator[Segment]:
    taken: dict[tuple[float, float], str] = {}
    start = 0.0
    for number, part in enumerate(case.segments, start=1):
        material = (part.stiffness, part.density)
        colour = taken.setdefault(material, _colour(material, set(taken.values())))
        end = start + LENGTH * part.fraction
        yield Segment(number, start, end, *material, colour)
        start = end


def _colour(material: tuple[float, float], taken: set[str]) -> str:
    """Orange for the reference, blue for stiffer, purple for denser, green for both; then whatever is free."""
    stiffness, density = material
    if stiffness == density == 1:
        wanted = ORANGE
    elif density == 1:
        wanted = BLUE if stiffness > 1 else SKY
    elif stiffness == 1:
        wanted = PURPLE if density > 1 else PINK
    else:
        wanted = GREEN
    free = [colour for colour in (wanted, *SPARE) if colour not in taken]
    return free[0] if free else wanted


def _from_points(numbers: np.ndarray[tuple[int, ...], np.dtype[np.int_]], s: Array) -> Iterator[Segment]:
    """Good to the distance of two points."""
    palette = (ORANGE, *SPARE)
    for number in range(1, int(numbers.max()) + 1):
        start, end = s[np.searchsorted(numbers, number)], s[np.searchsorted(numbers, number, side="right")]
        yield Segment(number, float(start), float(end), None, None, palette[(number - 1) % len(palette)])
