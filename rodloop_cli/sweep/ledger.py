"""Which members of a folder are done."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from rodloop_cli.sweep.columns import Row, status_of
from rodloop_cli.sweep.manifest import Manifest

ROW_ATTRIBUTE = "sweep_row"
"""Global attribute of a member's result file: its row, in case the manifest was not reached any more."""


class Ledger:
    """Members with a result: by content, and which content each result file has."""

    def __init__(self, folder: Path, *, read_only: bool = False) -> None:
        self._folder = folder
        self._manifest = Manifest(folder)
        self._read_only = read_only
        self._keys: set[bytes] = set()
        self._files: dict[str, bytes] = {}

    def refresh(self) -> None:
        """Take in what was added to the manifest, by this process or others."""
        if self._manifest.is_replaced():  # workers of a cluster outlive the folders that they write to
            self._keys.clear()
            self._files.clear()
        for row in self._manifest.fresh():
            self._enter(row)

    def is_done(self, name: str, key: str, *, keeps_fields: bool) -> bool:
        """Whether a member needs no run: it has a row, and with fields a result file of this content."""
        if not keeps_fields:
            return _digest(key) in self._keys
        path = self._folder / f"{name}.nc"
        if not path.is_file():
            return False
        return self._files.get(name) == _digest(key) or self._is_recovered(path, key)

    def is_of_another_case(self, name: str, key: str) -> bool:
        """Whether the result file of this name has other contents than a member would give it."""
        return self._files.get(name, _digest(key)) != _digest(key) and (self._folder / f"{name}.nc").is_file()

    def _enter(self, row: Row) -> None:
        if not status_of(row).is_done:
            return
        key = _digest(str(row["key"]))
        self._keys.add(key)
        if row.get("has_file"):
            self._files[str(row.get("member"))] = key

    def _is_recovered(self, path: Path, key: str) -> bool:
        """Whether the file itself says so: its worker was killed before the line in the manifest, or that is lost."""
        row = _row_in(path)
        if row.get("key") != key or not status_of(row).is_done:
            return False
        if not self._read_only:
            self._manifest.append(row)
        self._enter(row)
        return True


def _digest(key: str) -> bytes:
    """Half of the key tells any number of members apart, and a million of them take 60 MB instead of 110."""
    return key[:32].encode()


def _row_in(path: Path) -> Row:
    import netCDF4  # noqa: PLC0415  rarely needed

    try:
        with netCDF4.Dataset(path) as dataset:
            row: Any = json.loads(dataset.getncattr(ROW_ATTRIBUTE))
    except (OSError, RuntimeError, AttributeError, ValueError, TypeError):
        return {}  # not a result of a sweep, or damaged
    return row if isinstance(row, dict) else {}
