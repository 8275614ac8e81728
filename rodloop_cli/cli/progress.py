"""A progress bar over the time of a run: on stderr, on a terminal only."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rodloop_cli.cli.settings import current_settings

if TYPE_CHECKING:
    from rodloop_cli.simulation import Progress


@contextmanager
def time_bar(t_end: float) -> Iterator[Progress | None]:
    """Something to call with the time reached; None where nobody watches."""
    if current_settings().quiet or not sys.stderr.isatty():
        yield None
        return
    from tqdm import tqdm

    form = "t = {n:.4g}/{total:.4g} |{bar}| {elapsed}<{remaining}"
    with tqdm(total=t_end, bar_format=form, leave=False, file=sys.stderr) as bar:

        def progress(time: float) -> None:
            bar.update(time - bar.n)

        yield progress
