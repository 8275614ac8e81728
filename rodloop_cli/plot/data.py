"""What drawings read of a result: plain arrays.

A file is data from a stranger. What is drawn is checked here, so that matplotlib never meets a NaN, an overflow or a
segment number that makes no sense.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import xarray as xr

from rodloop_cli.errors import OutputError

Array = npt.NDArray[np.float64]
Frames = int | slice | list[int]

LENGTH = 2 * np.pi
"""Of the loop, in R."""
LARGEST = 1e30
"""Beyond this matplotlib's own arithmetic overflows."""
FARTHEST = 1e6
"""Of a loop of length 2 pi from where it started."""
MOST_SEGMENTS = 1000
"""As many as a case can have."""

ALL = slice(None)


def values(dataset: xr.Dataset, name: str, frames: Frames = ALL) -> Array:
    """A variable on (t), (s) or (t, s) at some frames. Raises OutputError if it cannot be read or drawn."""
    try:
        variable = dataset[name]
        read = variable.to_numpy()
    except (KeyError, OSError, RuntimeError) as error:
        raise OutputError(f"{place(dataset)}{name} cannot be read: {' '.join(str(error).split())}") from error
    chosen = read[frames] if "t" in variable.dims else read
    array = np.asarray(chosen, dtype=np.float64)
    if not (np.abs(array) < (FARTHEST if name in {"x", "y"} else LARGEST)).all():
        raise OutputError(f"{place(dataset)}{name} holds numbers that are not finite or too large; run the case again")
    return array


def times(dataset: xr.Dataset) -> Array:
    """The stored times (t,), increasing."""
    return values(dataset, "t")


def closed_arclength(dataset: xr.Dataset) -> Array:
    """(S + 1,): s with its end 2 pi, which a file does not repeat."""
    s = values(dataset, "s")
    if not ((np.diff(s) > 0).all() and s[0] >= 0 and s[-1] < LENGTH):
        raise OutputError(f"{place(dataset)}s does not increase within [0, 2 pi); run the case again")
    return np.append(s, LENGTH)


def closed_profile(dataset: xr.Dataset, name: str, frame: int) -> Array:
    """(S + 1,): a periodic profile at one frame, its first value repeated at 2 pi."""
    profile = values(dataset, name, frame)
    return np.append(profile, profile[0])


def segment_numbers(dataset: xr.Dataset) -> npt.NDArray[np.int_]:
    """(S,): the segment of every point, 1 and up, not decreasing."""
    numbers = values(dataset, "segment").astype(np.int_)
    if numbers.min() < 1 or numbers.max() > MOST_SEGMENTS or (np.diff(numbers) < 0).any():
        raise OutputError(f"{place(dataset)}segment does not count 1, 2, ... along s; run the case again")
    return numbers


def thinned(count: int, most: int) -> slice:
    """Every n-th of `count` rows, so that no more than `most` are left."""
    return slice(None, None, max(1, -(-count // most)))


def place(dataset: xr.Dataset) -> str:
    """``FILE: `` for messages, nothing for a dataset that is in no file."""
    source = dataset.encoding.get("source")
    return f"{source}: " if source else ""
