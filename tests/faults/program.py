"""The program in a process of its own, slowed down and with many checkpoints, so that kills have something to hit."""

import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

SOURCE = """
import sys, time
try:
    from rodloop_cli.simulation import resume
    resume.SECONDS_BETWEEN = 0.1
    at_once = resume.Keeper.after_step
    resume.Keeper.after_step = lambda keeper: time.sleep(0.03) or at_once(keeper)
    from rodloop_cli.cli import main
except KeyboardInterrupt:  # Python is not up yet
    sys.exit(130)
sys.exit(main(sys.argv[1:]))
"""
CASE = "p: 3.8\nt_end: 9.6\ntol: 1e-6\nsnapshots: 100\nstop_at: []\nperturbation: [{mode: 2, amplitude: 5e-3}]\n"
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def started(*arguments: str, file_size: int | None = None) -> subprocess.Popen[str]:
    """``rodloop`` with these arguments; ``file_size`` limits every file it writes."""

    def limit() -> None:
        if file_size is not None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (file_size, file_size))

    return subprocess.Popen(
        [sys.executable, "-c", SOURCE, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | ONE_THREAD,
        preexec_fn=limit,  # noqa: PLW1509  there are no threads
    )


def run(*arguments: str, file_size: int | None = None) -> tuple[int, str]:
    """The exit code, and what it said on stderr."""
    process = started(*arguments, file_size=file_size)
    _, said = process.communicate(timeout=120)
    return process.returncode, said


def struck(number: int, after: float, part: Path, *arguments: str) -> tuple[int, str]:
    """Like `run`, with a signal so many seconds after the first rows are on disk."""
    process = started(*arguments)
    while process.poll() is None and not part.exists():
        time.sleep(0.005)
    time.sleep(after)
    if process.poll() is None:
        process.send_signal(number)
    _, said = process.communicate(timeout=120)
    return process.returncode, said
