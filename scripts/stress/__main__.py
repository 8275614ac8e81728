"""`python -m scripts.stress random|maps|long|inputs [--quick]`: what `make stress` runs; numbers on stdout."""

import argparse
from pathlib import Path

from scripts.stress.inputs import case_files, fuzz
from scripts.stress.long import drift, rest, way_back
from scripts.stress.maps import MAPS, draw_map, run_map
from scripts.stress.random_cases import run_random, told

FIGURES = Path("docs/figures")
DAMPED = (
    {"p": 2.0, "zeta_perp": 5.0, "stiffness_ratio": 5.0, "t_end": 1e4},
    {"p": -5.0, "zeta_perp": 1.0, "stiffness_ratio": 2.0, "t_end": 1e4},
    {"p": 3.8, "zeta_perp": 3.0, "stiffness_ratio": 12.8, "t_end": 1e4},
)


def random(arguments: argparse.Namespace) -> None:
    """Random combinations."""
    count = 20 if arguments.quick else arguments.count
    print("\n".join(told(run_random(arguments.first, count, arguments.seconds, arguments.folder))))


def maps(arguments: argparse.Namespace) -> None:
    """The maps asked for, all by default."""
    for name in arguments.names or (["drag"] if arguments.quick else MAPS):
        trials = run_map(MAPS[name], arguments.seconds)
        draw_map(MAPS[name], trials, FIGURES / f"stability_{name}.png")
        kinds = [trial.kind for row in trials for trial in row]
        print(name, {kind: kinds.count(kind) for kind in sorted(set(kinds))}, flush=True)


def long(arguments: argparse.Namespace) -> None:
    """Long runs, and runs that come to rest."""
    for tol in (1e-4,) if arguments.quick else (1e-4, 1e-5, 1e-6):
        print(drift(tol, 3 if arguments.quick else 100), "way back:", way_back(tol, 4.0), flush=True)
    for case in DAMPED:
        print(case, *rest(case), flush=True)


def inputs(arguments: argparse.Namespace) -> None:
    """Broken case files."""
    tally = fuzz(case_files(), 500 if arguments.quick else 20_000, arguments.first)
    print(
        f"{tally.tried} broken case files: {tally.refused} refused, {tally.accepted} still valid, "
        f"{len(tally.wrongly_accepted)} accepted wrongly, {len(tally.unexplained)} unexplained, "
        f"slowest {tally.slowest:.2f} s"
    )


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(prog="python -m scripts.stress", description=__doc__)
    parser.add_argument("what", choices=["random", "maps", "long", "inputs", "all"])
    parser.add_argument("names", nargs="*", help="of maps")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seconds", type=float, default=20.0, help="limit of one run")
    parser.add_argument("--folder", type=Path, default=Path("out/stress"))
    arguments = parser.parse_args()
    parts = {"random": random, "maps": maps, "long": long, "inputs": inputs}
    for part in parts.values() if arguments.what == "all" else [parts[arguments.what]]:
        part(arguments)


if __name__ == "__main__":
    main()
