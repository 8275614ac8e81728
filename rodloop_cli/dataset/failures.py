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
        raise OutputError(f"{path}: {_reason(error, path.parent)}{kept()}") from error


def _reason(error: Exception, folder: Path) -> str:
    number = error.errno if isinstance(error, OSError) else None
    if not folder.is_dir():
        return f"the folder {folder} is gone; create it again or {_REMEDY}"
    if number in _FULL and isinstance(error, OSError):
        return f"the disk is full ({error.strerror}); free some room or {_REMEDY}"
    if number in _FORBIDDEN:
        return f"no permission to write in {folder}; change it or {_REMEDY}"
    return f"cannot be written ({error}); if the disk is full or over quota, free some room, else {_REMEDY}"
