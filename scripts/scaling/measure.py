"""What a sweep costs beyond the solver: the numbers of docs/scaling.md.

    python scripts/scaling/measure.py speedup       two processes against one, 200 members
    python scripts/scaling/measure.py overhead      a member in a warm worker against the bare solver
    python scripts/scaling/measure.py diagram       the 1000 members of configs/sweeps/phase_diagram.yaml, three kills
    python scripts/scaling/measure.py growth        planning, manifest and sweep.nc for up to 100000 members

Each prints a table. Run them on a quiet machine; the least of several times is given where times are repeated.
"""

from __future__ import annotations

import itertools
import random
import statistics
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from rodloop_cli.case import Case
from rodloop_cli.simulation import Run
from rodloop_cli.sweep.columns import Status
from rodloop_cli.sweep.conduct import run_member
from rodloop_cli.sweep.file import read_sweep
from rodloop_cli.sweep.gather import gather
from rodloop_cli.sweep.ledger import Ledger
from rodloop_cli.sweep.manifest import MANIFEST, Manifest
from rodloop_cli.sweep.observe import Nowhere
from rodloop_cli.sweep.plan import planned
from rodloop_cli.sweep.task import Task

REPEATS = 3
PHASE_DIAGRAM = Path(__file__).parents[2] / "configs" / "sweeps" / "phase_diagram.yaml"

SPEEDUP = """
base: {p: 8, t_end: 2.0}
grid:
  stiffness_ratio: {linspace: [2, 6, 10]}
  p: {linspace: [5, 100, 20]}
"""
TINY = """
base: {{p: 4, t_end: 1.0}}
grid:
  p: {{linspace: [1, 50, {rows}]}}
  k: {{linspace: [0.1, 0.9, 100]}}
output: scalars
"""


def sweep(path: Path, folder: Path, *options: str) -> float:
    """Seconds of the command."""
    clock = time.perf_counter()
    command = [sys.executable, "-m", "rodloop_cli", "-q", "sweep", str(path), "-o", str(folder), *options]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - clock


def speedup(place: Path) -> None:
    """One process and two by turns."""
    path = place / "speedup.yaml"
    path.write_text(SPEEDUP)
    print("processes  seconds")
    least = {}
    for jobs in ("1", "2"):
        times = [sweep(path, place / f"{jobs}-{i}", "-j", jobs) for i in range(REPEATS)]
        least[jobs] = min(times)
        print(f"{jobs:>9}  {', '.join(f'{t:.2f}' for t in times)}")
    print(f"speedup {least['1'] / least['2']:.2f}")


def overhead(place: Path) -> None:
    """Milliseconds from the start of a member to its closed file, less those of the solver for the same case."""
    print("output    snapshots x points   solver ms   overhead ms (median, largest)")
    for keeps_fields in (True, False):
        for snapshots, points in ((200, 200), (50, 128)):
            cases = [{"p": p / 2, "t_end": 1.0, "stiffness_ratio": 3} for p in range(10, 40)]
            pairs = [
                _pair(place, values | {"snapshots": snapshots, "output_points": points}, keeps_fields)
                for values in cases
            ][3:]  # warm
            solver = statistics.median(bare for bare, _ in pairs)
            extra = [whole - bare for bare, whole in pairs]
            words = f"{snapshots} x {points}"
            kind = "fields" if keeps_fields else "scalars"
            print(f"{kind:8}  {words:19}  {solver:9.1f}   {statistics.median(extra):.1f}, {max(extra):.1f}")


def _pair(place: Path, values: dict[str, float], keeps_fields: bool) -> tuple[float, float]:
    case = Case.model_validate(values)
    name = f"{case.sha256[:12]}-{keeps_fields}"
    bare = _least(lambda: Run.of(case).into(Nowhere()))
    runs = iter(range(REPEATS))

    def whole() -> object:
        key = f"{name}-{next(runs)}"
        return run_member(Task(str(place), key, key, values, keeps_fields))

    return bare, _least(whole)


def _least(action: Callable[[], object]) -> float:
    def once() -> float:
        clock = time.perf_counter()
        action()
        return 1e3 * (time.perf_counter() - clock)

    return min(once() for _ in range(REPEATS))


def diagram(place: Path) -> None:
    """The time of a whole sweep that is killed on the way, and whether it lost or repeated anything."""
    folder = place / "diagram"
    dice = random.Random(1)  # noqa: S311
    clock = time.perf_counter()
    for _ in range(3):
        command = [sys.executable, "-m", "rodloop_cli", "-q", "sweep", str(PHASE_DIAGRAM), "-o", str(folder)]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL) as running:
            time.sleep(5 + 25 * dice.random())
            running.kill()
        done = len(list(Manifest(folder).fresh()))
        print(f"killed after {time.perf_counter() - clock:.1f} s with {done} members done")
    sweep(PHASE_DIAGRAM, folder)
    rows = list(Manifest(folder).fresh())
    seconds = [float(row["cpu_seconds"]) for row in rows]
    most = Counter(row["key"] for row in rows).most_common(1)[0][1]
    print(f"{len(rows)} members in {time.perf_counter() - clock:.1f} s; the most often run one ran {most} time(s)")
    print(f"processor seconds a member: median {statistics.median(seconds):.3f}, mean {statistics.mean(seconds):.3f}")
    print(f"cases per core-hour: {3600 / statistics.mean(seconds):.0f}")
    print(f"bytes a member: manifest {(folder / MANIFEST).stat().st_size / len(rows):.0f}", end=", ")
    print(f"sweep.nc {(folder / 'sweep.nc').stat().st_size / len(rows):.0f}")


def growth(place: Path) -> None:
    """Everything around the solver, for members that are made up."""
    print("members    plan s   append ms each   look-up s   gather s   manifest MB   sweep.nc MB")
    for count in (1_000, 10_000, 100_000):
        folder = place / str(count)
        folder.mkdir()
        path = place / f"{count}.yaml"
        path.write_text(TINY.format(rows=count // 100))
        marks = [time.perf_counter()]
        plan = planned(read_sweep(str(path)))
        marks.append(time.perf_counter())
        manifest = Manifest(folder)
        for member in plan.members:
            manifest.append({**_MADE_UP, "key": member.key, "member": member.name})
        marks.append(time.perf_counter())
        ledger = Ledger(folder)
        ledger.refresh()
        assert all(ledger.is_done(member.name, member.key, keeps_fields=False) for member in plan.members)
        marks.append(time.perf_counter())
        result = gather(plan, folder)
        marks.append(time.perf_counter())
        made, appended, looked_up, gathered = (b - a for a, b in itertools.pairwise(marks))
        sizes = [file.stat().st_size / 1e6 for file in (folder / MANIFEST, result)]
        print(f"{count:7}  {made:8.2f}  {1e3 * appended / count:15.3f}", end="  ")
        print(f"{looked_up:10.2f}  {gathered:9.2f}  {sizes[0]:12.1f}  {sizes[1]:12.1f}")


_MADE_UP: dict[str, str | int | float] = {
    "has_file": 0,
    "status": int(Status.crossed),
    "outcome": "stopped at first crossing, t = 0.4996",
    **dict.fromkeys(("dissipated_energy", "period", "first_crossing_time", "end_time", "growth_rate"), 0.1234567890123),
    **dict.fromkeys(("maximum_displacement", "minimum_area", "peak_bending_energy", "wall_seconds"), 1.234567890123),
    **dict.fromkeys(("peak_surface_energy", "peak_kinetic_energy", "largest_energy_residual"), 12.34567890123),
    **dict.fromkeys(("lobes_initial", "lobes_final", "steps", "rejected", "newton_iterations", "cells"), 42),
}

MEASUREMENTS = {"speedup": speedup, "overhead": overhead, "diagram": diagram, "growth": growth}


def main() -> None:
    """Run the measurements that are named, or all."""
    for name in sys.argv[1:] or MEASUREMENTS:
        with tempfile.TemporaryDirectory() as place:
            MEASUREMENTS[name](Path(place))


if __name__ == "__main__":
    main()
