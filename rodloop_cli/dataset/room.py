"""Noticing a full disk or an exhausted quota before it does harm.

HDF5 must never run out of room: it cannot close its file then, and rows that were safe before are lost with it.
"""

from __future__ import annotations

import errno
import os
import shutil
import sys
import tempfile
from pathlib import Path

RESERVE_BYTES = 512 * 1024
"""Kept free for the file's own structures."""

_AHEAD_BYTES = 16 * 2**20
"""Room tried out at a time: trying takes 3 ms whatever the size, so a run of the usual size does it once."""

_FULL = (errno.ENOSPC, errno.EDQUOT)
_UNSUPPORTED = (errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL)


class Room:
    """What is left to write in `folder`, by the disk's free space and, on Linux, by the user's quota."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._tried_out = 0

    def take(self, size: int) -> None:
        """Raise OSError (ENOSPC, EDQUOT) unless `size` bytes and the reserve can be written now."""
        needed = size + RESERVE_BYTES
        free = shutil.disk_usage(self._folder).free
        if free < needed:
            raise OSError(errno.ENOSPC, f"{free / 1e6:.1f} MB free, {needed / 1e6:.1f} MB needed")
        # The free space of the disk does not tell of a quota, so room is taken for a moment and given back.
        if self._tried_out < needed:
            self._tried_out = self._try_out(needed)
        self._tried_out -= size

    def _try_out(self, needed: int) -> int:
        try:
            _allocate(self._folder, needed + _AHEAD_BYTES)
        except OSError as error:
            if error.errno not in _FULL:
                raise
            _allocate(self._folder, needed)
            return needed
        return needed + _AHEAD_BYTES


def _allocate(folder: Path, size: int) -> None:
    if sys.platform != "linux":
        return
    with tempfile.TemporaryFile(dir=folder) as ballast:
        try:
            os.posix_fallocate(ballast.fileno(), 0, size)
        except OSError as error:
            if error.errno not in _UNSUPPORTED:
                raise
