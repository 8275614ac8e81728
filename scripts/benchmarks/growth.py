"""How time and memory grow: with cells, time span, stored rows, segments.

python -m scripts.benchmarks.growth [--quick]
"""

import argparse
import resource
import time
from math import log
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from rodloop_cli.case import Case, ModePerturbation, Segment
from rodloop_cli.dataset.writer import RunWriter
from rodloop_cli.numerics.allocator import keep_freed_memory
from rodloop_cli.simulation import Run

STEPS = 12
"""Steps timed for one number of cells."""


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    keep_freed_memory()
    # The peak of memory is that of the process so far: what needs most comes last.
    with_rows([100, 1000] if quick else [100, 1000, 10000])
    with_span([9.6, 96.0])
    with_segments([1, 2, 8, 32])
    with_cells([16, 64, 256, 1024] if quick else [16, 64, 256, 1024, 4096, 16384])


def buckling(**settings: object) -> Case:
    """The homogeneous loop at low pressure."""
    base = {"p": 3.8, "t_end": 9.6, "perturbation": (ModePerturbation(mode=2, amplitude=5e-3),), "snapshots": 2}
    return Case(**(base | settings))  # type: ignore[arg-type]


def with_cells(counts: list[int]) -> None:
    """Milliseconds a step (accepted or not) for uniform meshes."""
    print("| cells | ms a step | peak memory / MB |\n|---|---|---|")
    times = []
    for cells in counts:
        run = Run.of(buckling(N=cells))
        steps = iter(run.marcher)
        next(steps)
        begun = time.perf_counter()
        for _ in range(STEPS):
            next(steps)
        attempts = run.work.steps + run.work.rejected + run.work.newton_failures - 1
        times.append((time.perf_counter() - begun) / attempts)
        print(f"| {cells} | {1e3 * times[-1]:.2f} | {peak_megabytes():.0f} |", flush=True)
    exponents = [log(b / a) / log(n / m) for a, b, m, n in zip(times, times[1:], counts, counts[1:], strict=False)]
    print("exponents:", ", ".join(f"{e:.2f}" for e in exponents), "\n")


def with_rows(counts: list[int]) -> None:
    """Seconds of a run into a file, for numbers of stored rows."""
    print("| stored rows | s | peak memory / MB |\n|---|---|---|")
    for rows in counts:
        run = Run.of(buckling(snapshots=rows))
        begun = time.perf_counter()
        with TemporaryDirectory() as folder:
            recorder = run.recorder
            path = Path(folder) / "run.nc"
            with RunWriter(path, s=recorder.s, segment=recorder.segment, attributes=run.attributes) as writer:
                run.into(writer)
        print(f"| {rows} | {time.perf_counter() - begun:.2f} | {peak_megabytes():.0f} |", flush=True)
    print()


def with_span(spans: list[float]) -> None:
    """Milliseconds of solver per unit time."""
    print("| t_end | steps | ms per unit time |\n|---|---|---|")
    for span in spans:
        run = Run.of(buckling(t_end=span))
        begun = time.perf_counter()
        count = sum(1 for _ in run.marcher)
        print(f"| {span:g} | {count} | {1e3 * (time.perf_counter() - begun) / span:.1f} |", flush=True)
    print()


def with_segments(counts: list[int]) -> None:
    """Milliseconds a step for segments of alternating stiffness."""
    print("| segments | cells | ms a step |\n|---|---|---|")
    for count in counts:
        stiffness = np.where(np.arange(count) % 2, 2.0, 1.0)
        segments = tuple(Segment(fraction=1 / count, stiffness=float(b)) for b in stiffness)
        disturbed = (ModePerturbation(mode=2, amplitude=5e-3),)
        run = Run.of(Case(p=3.8, t_end=1.0, segments=segments, perturbation=disturbed))
        begun = time.perf_counter()
        steps = sum(1 for _ in run.marcher)
        cells = run.marcher.state.equations.mesh.cells
        print(f"| {count} | {cells} | {1e3 * (time.perf_counter() - begun) / steps:.2f} |", flush=True)


def peak_megabytes() -> float:
    """Largest resident memory of this process so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


if __name__ == "__main__":
    main()
