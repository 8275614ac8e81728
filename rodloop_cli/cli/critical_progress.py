"""A progress bar over items: on stderr, on a terminal only."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rodloop_cli.cli.settings import current_settings


@contextmanager
def item_bar(total: int, unit: str) -> Iterator[Callable[[], object]]:
    """Something to call once an item; it shows nothing where nobody watches."""
    if current_settings().quiet or not sys.stderr.isatty():
        yield lambda: None
        return
    from tqdm import tqdm

    with tqdm(total=total, unit=unit, leave=False, file=sys.stderr) as bar:
        yield bar.update
