"""What is done: one line of JSON for each member that ended, appended to a file in the sweep's folder.

A line is appended in one write under a lock, by the process that ran the member, so that members of several sweeps
and machines may end at once and a kill at any instant costs at most the line being written. Readers skip a torn
line; the next writer ends it first. Nothing is ever changed or removed: the latest line on a member holds.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rodloop_cli.sweep.columns import Row

if sys.platform != "win32":
    import fcntl

MANIFEST = "manifest.jsonl"
SUMMARY = "sweep.nc"


class Manifest:
    """The lines of a folder's manifest, read as they come."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / MANIFEST
        self._offset = 0
        self._inode = 0

    def append(self, row: Row) -> None:
        """Write one line. Raises OSError where that is not possible."""
        line = json.dumps(row, allow_nan=False).encode() + b"\n"
        descriptor = os.open(self._path, os.O_RDWR | os.O_APPEND | os.O_CREAT, 0o666)
        try:
            with _locked(descriptor):
                os.write(descriptor, line if _ends_whole(descriptor) else b"\n" + line)
        finally:
            os.close(descriptor)

    def is_replaced(self) -> bool:
        """Whether the file is another one than was read before, or gone; `fresh` starts from its beginning then."""
        try:
            found = self._path.stat()
            inode, size = found.st_ino, found.st_size
        except FileNotFoundError:
            inode, size = 0, 0
        if inode == self._inode and size >= self._offset:
            return False
        self._inode, self._offset = inode, 0
        return True

    def fresh(self) -> Iterator[Row]:
        """The rows that were added since the last call, or ever."""
        try:
            file = self._path.open("rb")
        except FileNotFoundError:
            return
        with file:
            file.seek(self._offset)
            for line in file:
                if not line.endswith(b"\n"):
                    return  # still being written: read it next time
                self._offset += len(line)
                row = _row(line)
                if row:
                    yield row


def _row(line: bytes) -> Row | None:
    try:
        row: Any = json.loads(line)
    except ValueError:
        return None
    return row if isinstance(row, dict) and isinstance(row.get("key"), str) else None


def _ends_whole(descriptor: int) -> bool:
    if os.fstat(descriptor).st_size == 0:
        return True
    os.lseek(descriptor, -1, os.SEEK_END)
    return os.read(descriptor, 1) == b"\n"


@contextlib.contextmanager
def _locked(descriptor: int) -> Iterator[None]:
    """Hold the lock of the file if the file system has locks; an append of one write is safe on most without."""
    if sys.platform != "win32":
        with contextlib.suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
    yield  # closing the file lets go of the lock
