"""``python -m scripts.paper [NAME ...]``: figures (all by default) to ``out/paper``; ``movies`` is all movies."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from itertools import chain

from scripts.paper.drawing import FIGURES, MOVIES, draw, runs_of
from scripts.paper.results import prepare, workers


def main(names: Sequence[str]) -> None:
    """Compute what is missing, then draw, both in two processes."""
    start = time.perf_counter()
    wanted = list(chain.from_iterable(MOVIES if name == "movies" else (name,) for name in names)) or list(FIGURES)
    unknown = [name for name in wanted if name not in FIGURES and name not in MOVIES]
    if unknown:
        sys.exit(f"no such figure: {', '.join(unknown)}; choose from {', '.join((*FIGURES, *MOVIES))}")
    prepare(chain.from_iterable(map(runs_of, wanted)))
    computed = time.perf_counter()
    with workers() as pool:
        for path in pool.map(draw, wanted):
            print(path)
    print(f"computed in {computed - start:.1f} s, drawn in {time.perf_counter() - computed:.1f} s", file=sys.stderr)


if __name__ == "__main__":
    main(sys.argv[1:])
