"""Do the tests notice a wrong equation? Single mutations of `physics/equations.py`, each against the quick tests.

    python scripts/mutation.py [-k WORD]

Every mutation is a replacement of text in a copy of the package: a sign flipped, a term dropped, segments swapped. The
tests run against the copy until the first failure; a mutation that fails none has survived. Prints a line for each and
the kill rate; the exit code is the number of survivors.
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[1]
MUTATED = Path("rodloop_cli") / "physics" / "equations.py"
TESTS = ("tests/physics/test_equations.py", "tests/motion/test_newton.py", "tests/reference", "tests/motion")
"""From the quickest to the slowest; the first failure ends the run."""

TIME_LIMIT = 240.0
"""Seconds; a mutation on which the program hangs counts as noticed."""

MUTATIONS: tuple[tuple[str, str, str], ...] = (
    ("pressure in Fx, sign", "np.multiply(direction[1], self.load.p", "np.multiply(direction[1], -self.load.p"),
    ("pressure in Fy, sign", "np.multiply(direction[0], -self.load.p", "np.multiply(direction[0], self.load.p"),
    ("pressure components swapped", "np.multiply(direction[1], self.load.p", "np.multiply(direction[0], self.load.p"),
    ("inertia dropped", "if acceleration.size:", "if False:"),
    ("inertia, sign", "density += self._density * acceleration", "density -= self._density * acceleration"),
    ("inertia without density", "density += self._density * acceleration", "density += acceleration"),
    ("drag dropped", "if velocity.size and self.load.zeta_perp:", "if False:"),
    ("drag, sign", "density += self._drag(", "density -= self._drag("),
    ("drag isotropic", "along *= self.load.gamma - 1", "along *= 0"),
    ("anisotropy, sign", "along *= self.load.gamma - 1", "along *= 1 - self.load.gamma"),
    ("anisotropy without 1", "along *= self.load.gamma - 1", "along *= self.load.gamma"),
    ("drag along the wrong vector", "velocity + along * direction", "velocity + along * direction[::-1]"),
    ("shear, sign of Fy cos", "shear -= force[1, ..., :-1] * cosine", "shear += force[1, ..., :-1] * cosine"),
    ("shear, Fx term halved", "shear = force[0, ..., :-1] * sine", "shear = 0.5 * force[0, ..., :-1] * sine"),
    ("shear, components swapped", "shear = force[0, ..., :-1] * sine", "shear = force[1, ..., :-1] * sine"),
    ("stiffness ignored", "(mesh.lengths / mesh.stiffness)", "(mesh.lengths / mesh.stiffness**0)"),
    ("stiffness inverted", "(mesh.lengths / mesh.stiffness)", "(mesh.lengths * mesh.stiffness)"),
    ("stiffness swapped", "mesh.lengths / mesh.stiffness", "mesh.lengths / mesh.stiffness[::-1]"),
    ("density swapped", "mesh.density[:, None]", "mesh.density[::-1, None]"),
    ("density ignored", "mesh.density[:, None]", "mesh.density[:, None] ** 0"),
    ("no turn round the loop", "self._turn[-1, THETA] = 2 * pi", "self._turn[-1, THETA] = 0.0"),
    ("turn in the wrong cell", "self._turn[-1, THETA]", "self._turn[0, THETA]"),
    ("loop left open", "out[..., -1, :NODAL] -= unknowns[..., 0, :NODAL]", "pass"),
    ("collocation without its angle", "out[..., NODAL:] -= unknowns[..., NODAL:]", "pass"),
    ("velocity without its past", "velocity += motion.velocity_past", "pass"),
    ("acceleration without its past", "acceleration += motion.acceleration_past", "pass"),
    ("acceleration from the wrong field", "motion.rates @ velocity.reshape", "motion.rates @ position.reshape"),
    ("rotary inertia, sign", "shear += self._density * self.load.rotary", "shear -= self._density * self.load.rotary"),
    ("rotary inertia of the wrong order", "(motion.rates @ spin.reshape(flat))", "spin.reshape(flat)"),
    (
        "rotary inertia not linearised",
        "shear[1][:, *angles] += self._density",
        "shear[1][:, *angles] += 0 * self._density",
    ),
    ("pressure response in Fx", "density[0, 0][:, *angles] = self.load.p * cosine", "pass"),
    ("pressure response in Fy, sign", "= self.load.p * sine", "= -self.load.p * sine"),
    ("drag response by angle, sign of u", "(square * v - cross * u)", "(square * v + cross * u)"),
    ("drag response by angle, Fy", "(square * u + cross * v)", "(square * u)"),
    ("drag response by position", "density[2, 0] = zeta * dx + along * c", "density[2, 0] = zeta * dx"),
    ("force response of the shear", "force[0] * cosine + force[1] * sine", "force[0] * cosine - force[1] * sine"),
    ("position response, sign", "(-sine * self._length)[:, None, :]", "(sine * self._length)[:, None, :]"),
    ("moment response to the node", "moment[0, ..., MOMENT] += 1", "pass"),
    ("turned the wrong way", "np.stack([-sine, cosine]) * (correction", "np.stack([sine, cosine]) * (correction"),
    (
        "extra force, shear",
        "(sine * force[0, :, :-1] - cosine * force[1, :, :-1])",
        "(sine * force[0, :, :-1] + cosine * force[1, :, :-1])",
    ),
)


def main() -> int:
    """Apply every mutation and count the survivors."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("-k", default="", metavar="WORD", help="only mutations whose name contains WORD")
    word = parser.parse_args().k
    original = (ROOT / MUTATED).read_text(encoding="utf-8")
    chosen = [mutation for mutation in MUTATIONS if word in mutation[0]]
    outdated = [name for name, old, _ in chosen if old not in original]
    if outdated:
        print("not in the text any more, mend the table:", *outdated, sep="\n  ")
        return 1
    with TemporaryDirectory() as folder:
        _copy_to(Path(folder))
        if not _passes(Path(folder)):
            print("the tests fail without a mutation")
            return 1
        survivors = [name for name, old, new in chosen if _survives(Path(folder), original, name, old, new)]
    killed = len(chosen) - len(survivors)
    print(f"{killed} of {len(chosen)} mutations noticed ({killed / max(1, len(chosen)):.0%})")
    return len(survivors)


def _copy_to(folder: Path) -> None:
    for part in ("rodloop_cli", "tests"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", folder)


def _survives(folder: Path, original: str, name: str, old: str, new: str) -> bool:
    (folder / MUTATED).write_text(original.replace(old, new, 1), encoding="utf-8")
    survived = _passes(folder)
    print(f"{'SURVIVED' if survived else 'noticed '}  {name}", flush=True)
    return survived


def _passes(folder: Path) -> bool:
    environment = os.environ | {"PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *TESTS]
    try:
        done = subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, timeout=TIME_LIMIT, check=False
        )
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0


if __name__ == "__main__":
    sys.exit(main())
