"""One writer for one result: an advisory lock beside the file.

The lock is `flock` on OUT.nc.lock, which the operating system lets go when a process dies, so that no lock is
ever stale. The lock file is removed on release; an empty one left behind by a killed run is harmless.
"""

from __future__ import annotations

import contextlib
import errno
import os
import sys
import warnings
from pathlib import Path

if sys.platform != "win32":
    import fcntl

_UNSUPPORTED = {errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS}


class OutputLock:
    """Held from construction until `release`; BlockingIOError if another process holds it."""

    def __init__(self, output: Path) -> None:
        self._path = output.with_name(output.name + ".lock")
        self._descriptor: int | None = None
        # The holder removes the file before letting go: a lock won on a file that is gone does not count.
        while self._descriptor is None:
            descriptor = os.open(self._path, os.O_CREAT | os.O_RDWR, 0o666)
            try:
                _lock(descriptor, self._path)
                if self._is_in_place(descriptor):
                    self._descriptor = descriptor
            finally:
                if self._descriptor is None:
                    os.close(descriptor)

    def release(self) -> None:
        """Remove the lock file and let go; calling it again does nothing."""
        if self._descriptor is None:
            return
        with contextlib.suppress(OSError):  # the folder may have vanished
            self._path.unlink()
        os.close(self._descriptor)
        self._descriptor = None

    def _is_in_place(self, descriptor: int) -> bool:
        try:
            return os.path.samestat(os.fstat(descriptor), self._path.stat())
        except FileNotFoundError:
            return False


def _lock(descriptor: int, path: Path) -> None:
    if sys.platform == "win32":
        return  # HDF5's own lock on the .part remains
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except OSError as error:
        if error.errno not in _UNSUPPORTED:
            raise
        warnings.warn(f"{path.parent}: no file locks here; do not start two runs to one output", stacklevel=2)
