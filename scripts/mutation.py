"""Do the tests notice a wrong equation? Single mutations of `physics`, each against the quick tests.

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
PHYSICS = Path("rodloop_cli") / "physics"
TESTS = (
    "tests/physics/test_equations.py",
    "tests/physics/test_whole_loop.py",
    "tests/motion/test_newton.py",
    "tests/reference",
    "tests/motion",
)
"""From the quickest to the slowest; the first failure ends the run."""

TIME_LIMIT = 240.0
"""Seconds; a mutation on which the program hangs counts as noticed."""

Replacement = tuple[str, str, str]
"""A name, the text replaced, and the text in its place."""

MUTATIONS: dict[str, tuple[Replacement, ...]] = {
    "equations.py": (
        ("pressure in Fx, sign", "np.multiply(tangent[1], self.load.p", "np.multiply(tangent[1], -self.load.p"),
        ("pressure in Fy, sign", "np.multiply(tangent[0], -self.load.p", "np.multiply(tangent[0], self.load.p"),
        ("pressure components swapped", "np.multiply(tangent[1], self.load.p", "np.multiply(tangent[0], self.load.p"),
        ("drag dropped", "if velocity.size and self.load.zeta_perp:", "if False:"),
        ("drag, sign", "film += self.drag(", "film -= self.drag("),
        ("drag isotropic", "along *= self.load.gamma - 1", "along *= 0"),
        ("anisotropy, sign", "along *= self.load.gamma - 1", "along *= 1 - self.load.gamma"),
        ("anisotropy without 1", "along *= self.load.gamma - 1", "along *= self.load.gamma"),
        ("drag along the wrong vector", "velocity + along * tangent", "velocity + along * tangent[::-1]"),
        ("stiffness ignored", "1 / mesh.stiffness[:, None]", "1 / mesh.stiffness[:, None] ** 0"),
        ("stiffness inverted", "1 / mesh.stiffness[:, None]", "mesh.stiffness[:, None]"),
        ("stiffness swapped", "1 / mesh.stiffness[:, None]", "1 / mesh.stiffness[::-1, None]"),
        ("density swapped", "mesh.density[:, None]", "mesh.density[::-1, None]"),
        ("density ignored", "mesh.density[:, None]", "mesh.density[:, None] ** 0"),
        ("velocity without its past", "velocity += motion.velocity_past", "pass"),
        ("acceleration without its past", "acceleration += motion.acceleration_past", "pass"),
        ("acceleration from the wrong field", "motion.rates @ velocity.reshape", "motion.rates @ position.reshape"),
        ("rotary inertia, sign", "couple: Array = self._density", "couple: Array = -self._density"),
        ("response of the couple, sign", "response: Array = self._density", "response: Array = -self._density"),
        ("rotary inertia of the wrong order", "(motion.rates @ spin.reshape(flat))", "spin.reshape(flat)"),
    ),
    "boxes.py": (
        ("inertia dropped", "if acceleration.size:", "if False:"),
        ("inertia, sign", "density += self._density * acceleration", "density -= self._density * acceleration"),
        ("inertia without density", "density += self._density * acceleration", "density += acceleration"),
        ("shear, sign of Fy cos", "shear -= force[1, ..., :-1] *", "shear += force[1, ..., :-1] *"),
        ("shear, Fx halved", "shear = force[0, ..., :-1] *", "shear = 0.5 * force[0, ..., :-1] *"),
        ("shear, components swapped", "shear = force[0, ..., :-1]", "shear = force[1, ..., :-1]"),
        ("no turn round the loop", "self._turn[-1, THETA] = 2 * pi", "self._turn[-1, THETA] = 0.0"),
        ("turn in the wrong cell", "self._turn[-1, THETA]", "self._turn[0, THETA]"),
        ("loop left open", "out[..., -1, :NODAL] -= unknowns[..., 0, :NODAL]", "pass"),
        ("collocation without its angle", "out[..., NODAL:] -= unknowns[..., NODAL:]", "pass"),
        ("rotary inertia not linearised", "angles] += self._density", "angles] += 0 * self._density"),
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
    ),
    "whole_loop.py": (
        ("pressure response", "np.multiply(sine_between, self.load.p", "np.multiply(sine_between, -self.load.p"),
        ("inertia response, sign", "self._twice_mass, -cosine_between", "self._twice_mass, cosine_between"),
        ("inertia response to the first node", "np.multiply(self._mass_before, -c", "np.multiply(self._mass_before, c"),
        ("inertia without density", "to_points * density @ to_points", "to_points @ to_points"),
        ("mass of the loop", "matrix[1, FX, X] = matrix[1, FY, Y] = -self._mass", "pass"),
        ("pressure on the closed loop", "matrix[0, X, angles], -self.load.p", "matrix[0, X, angles], self.load.p"),
        ("isotropic drag response", "-zeta * self._twice * cosine_between", "zeta * self._twice * cosine_between"),
        ("anisotropic drag response", "+ excess * (sine_between @ sine_between)", ""),
        ("drag response by angle", "square * v - cross * u", "square * v + cross * u"),
        ("drag on the closed loop", "[0, FORCE, angles] -= self._weights", "[0, FORCE, angles] += self._weights"),
        ("rotary inertia not linearised", "shear[1, :, angles] += self._inertia_of_turning", "pass"),
        ("force along the rod", "force[0].ravel() * c + force[1]", "force[0].ravel() * c - force[1]"),
        ("extra force, shear", "shear -= cosine * points[1]", "shear += cosine * points[1]"),
        ("extra force, its end", "out[FORCE] += force[:, -1]", "pass"),
        ("moved the wrong way", "np.multiply(sine.ravel(), -angles", "np.multiply(sine.ravel(), angles"),
    ),
    "loop_integrals.py": (
        ("loop closes without a turn", "turn[0, THETA] = 2 * pi", "turn[0, THETA] = 0.0"),
        ("force without density", "self.density_at_points[:, None] * to_places", "to_places"),
        ("stiffness ignored", "-(to_points * compliance) @ to_points", "-to_points @ to_points"),
        ("moment of the first node", "self._constant[NODAL:, MOMENT] = -(to_points @ compliance)", "pass"),
        ("angle of the first node", "self._constant[NODAL:, THETA] = -1.0", "pass"),
    ),
    "lifted.py": (
        ("forces out of balance, sign", "shear += missing", "shear -= missing"),
        ("forces out of balance, dropped", "missing *= self._frozen_normal", "missing *= 0"),
        ("forces that push across", "missing *= self._frozen_normal", "missing *= self._frozen_tangent"),
        ("lifted forces, response to a turn", "self._frozen_normal, -correction", "self._frozen_normal, correction"),
        ("lifted forces, pressure", "np.multiply(self._frozen_pressure", "np.multiply(-self._frozen_pressure"),
        ("lifted forces, drag", "+= self._loop.drag(self._frozen_tangent", "-= self._loop.drag(self._frozen_tangent"),
        (
            "lifted forces, inertia",
            "np.matmul(self._twice, inside, out=densities",
            "np.matmul(self._motion.rates, inside, out=densities",
        ),
        ("lifted moment", "shear += along * self._correction[:, NODAL:]", "pass"),
        ("lifted moment, response of the forces", "shear = self._response[..., : self._points] *", "shear = 0 *"),
        ("normal, sign", "np.negative(self._tangent[0], out=self._normal[1])", "self._normal[1] = self._tangent[0]"),
        ("velocity without its past", "velocity += self._at_points(self._motion.velocity_past)", "pass"),
        ("acceleration without its past", "acceleration += self._past", "pass"),
        (
            "start of the forces",
            "self._densities[..., -1] = self._unknowns[:, FORCE].T",
            "self._densities[..., -1] = 0",
        ),
        ("loop not closed", "np.subtract(self._position[..., -1].T", "np.subtract(0 * self._position[..., -1].T"),
        ("couple dropped", "self._shear += couple.reshape", "couple.reshape"),
        ("lifted moment, couple dropped", "self._shear += response.reshape", "response.reshape"),
    ),
}


def main() -> int:
    """Apply every mutation and count the survivors."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("-k", default="", metavar="WORD", help="only mutations whose name contains WORD")
    word = parser.parse_args().k
    chosen = [(file, *one) for file, table in MUTATIONS.items() for one in table if word in one[0]]
    outdated = [f"{file}: {name}" for file, name, old, _ in chosen if old not in _text(file)]
    if outdated:
        print("not in the text any more, mend the table:", *outdated, sep="\n  ")
        return 1
    with TemporaryDirectory() as folder:
        _copy_to(Path(folder))
        if not _passes(Path(folder)):
            print("the tests fail without a mutation")
            return 1
        survivors = [name for file, name, old, new in chosen if _survives(Path(folder), file, name, old, new)]
    killed = len(chosen) - len(survivors)
    print(f"{killed} of {len(chosen)} mutations noticed ({killed / max(1, len(chosen)):.0%})")
    return len(survivors)


def _text(file: str) -> str:
    return (ROOT / PHYSICS / file).read_text(encoding="utf-8")


def _copy_to(folder: Path) -> None:
    for part in ("rodloop_cli", "tests"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", folder)


def _survives(folder: Path, file: str, name: str, old: str, new: str) -> bool:
    mutated = folder / PHYSICS / file
    mutated.write_text(_text(file).replace(old, new, 1), encoding="utf-8")
    survived = _passes(folder)
    mutated.write_text(_text(file), encoding="utf-8")
    print(f"{'SURVIVED' if survived else 'noticed '}  {file}: {name}", flush=True)
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
