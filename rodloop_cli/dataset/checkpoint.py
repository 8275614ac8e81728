"""Where a run can be taken up again: numbers and arrays in OUT.nc.checkpoint, beside OUT.nc.part.

A zip of .npy files without pickles, so that a checkpoint is data only. Written to a temporary name, synced and
renamed: a kill leaves the old one or the new one. The rows it counts on are on disk before it is.
"""

from __future__ import annotations

import contextlib
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt

Arrays = dict[str, npt.NDArray[np.float64]]

_KEY = "key"


def checkpoint_path(output: Path) -> Path:
    """Beside the result."""
    return output.with_name(output.name + ".checkpoint")


def save_checkpoint(output: Path, key: str, arrays: Mapping[str, npt.NDArray[np.float64]]) -> None:
    """Write the arrays; ``key`` says which run they belong to. Raises OSError."""
    path = checkpoint_path(output)
    temporary = path.with_name(path.name + ".new")
    with temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, **{_KEY: np.frombuffer(key.encode(), dtype=np.uint8)}, **arrays)
        file.flush()
        os.fsync(file.fileno())
    temporary.replace(path)


def load_checkpoint(output: Path, key: str) -> Arrays | None:
    """The arrays, None if there is no checkpoint, or none that is whole and belongs to this run."""
    try:
        with checkpoint_path(output).open("rb") as file, np.load(file, allow_pickle=False) as stored:
            if bytes(stored[_KEY]) != key.encode():
                return None
            return {name: stored[name] for name in stored.files if name != _KEY}
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None


def remove_checkpoint(output: Path) -> None:
    """Once the result is whole."""
    with contextlib.suppress(OSError):
        checkpoint_path(output).unlink()
