"""CF compliance of the program's files, by the IOOS compliance checker: `make cf-check`.

Run by the project's own Python; the checker lives in an environment of its own, whose program is the argument.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

STANDARD = "cf:1.11"
CASE = "p: 16\nt_end: 0.4\nsnapshots: 11\nstiffness_ratio: 2\n"
SWEEP = "base: case.yaml\ngrid: {p: [8, 16]}\n"
COMMANDS = {
    "run.nc": ("run", "case.yaml", "-o", "run.nc"),
    "sweep/sweep.nc": ("sweep", "sweep.yaml", "-o", "sweep", "-j", "1"),
    "modes.nc": ("modes", "case.yaml", "--set", "p=2", "-o", "modes.nc"),
    "critical.nc": ("critical", "--stiffness-ratio", "2,5", "-j", "1", "-o", "critical.nc"),
}


def made(folder: Path) -> list[Path]:
    """One file of every kind."""
    (folder / "case.yaml").write_text(CASE)
    (folder / "sweep.yaml").write_text(SWEEP)
    for name, command in COMMANDS.items():
        words = [sys.executable, "-m", "rodloop_cli", "-q", *command]
        subprocess.run(words, cwd=folder, check=False, stdout=subprocess.DEVNULL)
        if not (folder / name).exists():
            print(f"{name}: not made by rodloop {' '.join(command)}")
    return [folder / name for name in COMMANDS if (folder / name).exists()]


def faults(checker: str, file: Path) -> list[str]:
    """What the checker finds wrong, one line each."""
    report = file.with_suffix(".json")
    command = [checker, f"--test={STANDARD}", "--format=json", f"--output={report}", str(file)]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    if not report.exists():
        return [f"the checker gave no report: {(ran.stderr or ran.stdout).strip()[-300:]}"]
    results = json.loads(report.read_text())[STANDARD]
    return [
        f"{level.removesuffix('_priorities')}: {item['name']}: {words}"
        for level in ("high_priorities", "medium_priorities", "low_priorities")
        for item in results[level]
        for words in item["msgs"]
    ]


def main() -> int:
    """Report on every file; 0 if nothing is wrong."""
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        files = made(Path(folder))
        for file in files:
            found = faults(sys.argv[1], file)
            wrong += len(found)
            print(f"{file.name}: {len(found)} findings of {STANDARD}", *found, sep="\n  ", flush=True)
        return int(wrong > 0 or len(files) < len(COMMANDS))


if __name__ == "__main__":
    sys.exit(main())
