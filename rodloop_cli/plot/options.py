"""What a user may ask of a drawing, read from the command line's words. Imports nothing heavy."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from rodloop_cli.errors import OutputError

MOST_TIMES = 1000
SMALLEST_SIZE, LARGEST_SIZE = 1.0, 100.0
LOWEST_DPI, HIGHEST_DPI = 10.0, 2400.0
LOWEST_FPS, HIGHEST_FPS = 0.1, 100.0
MOST_PIXELS = 2e8


@dataclass(frozen=True)
class Options:
    """`times`: wanted ones, empty for the kind's own choice; `size` in inches and `dpi`: None for the kind's own."""

    times: tuple[float, ...] = ()
    size: tuple[float, float] | None = None
    dpi: float | None = None
    fps: float = 25.0

    def __post_init__(self) -> None:
        _check_range("--fps", self.fps, LOWEST_FPS, HIGHEST_FPS)
        if self.dpi is not None:
            _check_range("--dpi", self.dpi, LOWEST_DPI, HIGHEST_DPI)
        for length in self.size or ():
            _check_range("--size", length, SMALLEST_SIZE, LARGEST_SIZE)
        if self.size and self.dpi and self.size[0] * self.size[1] * self.dpi**2 > MOST_PIXELS:
            raise OutputError(f"--size and --dpi make more than {MOST_PIXELS:.0e} pixels; make one of them smaller")


def read_times(text: str | None) -> tuple[float, ...]:
    """``0,0.55,1.125`` as numbers."""
    words = [word for word in re.split(r"[,\s]+", text or "") if word]
    if len(words) > MOST_TIMES:
        raise OutputError(f"--times: at most {MOST_TIMES} times can be drawn (got {len(words)})")
    return tuple(_number("--times", word, "numbers with commas between them, as in 0,0.5,1") for word in words)


def read_size(text: str | None) -> tuple[float, float] | None:
    """``8x5`` as width and height."""
    if text is None:
        return None
    words = text.lower().replace("×", "x").split("x")
    rule = "width x height in inches, as in 8x5"
    if len(words) != 2:
        raise OutputError(f"--size: must be {rule} (got '{text[:40]}')")
    return _number("--size", words[0], rule), _number("--size", words[1], rule)


def _number(option: str, word: str, rule: str) -> float:
    try:
        number = float(word)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise OutputError(f"{option}: must be {rule} (got '{word[:40]}')")
    return number


def _check_range(option: str, number: float, least: float, most: float) -> None:
    if not least <= number <= most:
        raise OutputError(f"{option}: must be between {least:g} and {most:g} (got {number:g})")
