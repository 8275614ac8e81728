"""Why a file cannot be written, in one line that says what to do."""

from __future__ import annotations

import contextlib
import errno
from collections.abc import Callable, Iterator
from pathlib import Path

from rodloop_cli.errors import OutputError

_FULL = (errno.ENOSPC, errno.EDQUOT)
_FORBIDDEN = (errno.EACCES, errno.EPERM, errno.EROFS)
_REMEDY = "choose another place with -o"


@contextlib.contextmanager
def writing(path: Path, kept: Callable[[], str]) -> Iterator[None]:
    """Turn OSError and RuntimeError (netCDF4's own) into OutputError; `kept` says which rows are safe."""
    try:
        yield
    except (OSError, RuntimeError) as error:
        raise OutputError(f"{path}: {_reason(error, path, kept)}") from error


def _reason(error: Exception, path: Path, kept: Callable[[], str]) -> str:
    number = error.errno if isinstance(error, OSError) else None
    if not path.parent.is_dir():
        return f"the folder {path.parent} is gone; create it again or {_REMEDY}"
    if number == errno.ENOENT:
        return f"files of this run in {path.parent} are gone, removed by somebody else; start again or {_REMEDY}"
    if number in _FULL and isinstance(error, OSError):
        return f"the disk is full ({error.strerror}); free some room or {_REMEDY}{kept()}"
    if number in _FORBIDDEN:
        return f"no permission to write in {path.parent}; change it or {_REMEDY}{kept()}"
    # A failure within HDF5 leaves its file in an unknown state, so nothing is promised about the rows.
    return f"cannot be written ({error}) and may be damaged; if the disk is failing, {_REMEDY}"
