"""A run that is struck down at any moment, and taken up again, ends like one that was left alone."""

import random
import signal
from pathlib import Path

import numpy as np
import pytest

from rodloop_cli.dataset import open_run
from rodloop_cli.errors import OutputError

from .program import CASE, run, struck

MOST_STRIKES = 12
"""In one run; many of them fall before it has taken up its work again."""

SIGNALS = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The case file and its uninterrupted result."""
    folder = tmp_path_factory.mktemp("whole")
    case, result = folder / "case.yaml", folder / "whole.nc"
    case.write_text(CASE)
    code, said = run("run", str(case), "-o", str(result))
    assert code == 0, said
    return case, result


def assert_same(result: Path, whole: Path) -> None:
    with open_run(result) as found, open_run(whole) as wanted:
        assert found.sizes == wanted.sizes
        assert found.attrs["outcome"] == wanted.attrs["outcome"]
        for name in wanted.data_vars:
            np.testing.assert_array_equal(found[name], wanted[name], err_msg=str(name))


def rows_left(output: Path) -> int:
    """Rows that the interrupted run left, all of them readable."""
    try:
        with open_run(output, partial=True) as found:
            assert np.isfinite(found.x.to_numpy()).all()
            return found.sizes["t"]
    except OutputError:
        return 0


def rounds(case: Path, whole: Path, folder: Path, seed: int) -> int:
    """Strike a run until it ends, and compare; the number of strikes."""
    draw = random.Random(seed)
    output = folder / f"{seed}.nc"
    arguments = ["run", str(case), "-o", str(output)]
    strikes, before = 0, 0
    for _ in range(MOST_STRIKES):
        number = draw.choice(SIGNALS)
        code, said = struck(number, draw.uniform(0.0, 1.5), output.with_name(output.name + ".part"), *arguments)
        assert "Traceback" not in said
        if code == 0:
            break
        assert code in {130, -number}, (code, said)
        if output.exists():  # struck between its last act and its exit
            assert_same(output, whole)
        left = rows_left(output)
        assert left >= before or left == 0
        strikes, before, arguments = strikes + 1, left, [*arguments[:4], "--resume"]
    else:
        code, said = run(*arguments)
        assert code == 0, said
    assert_same(output, whole)
    assert not list(folder.glob(f"{seed}.nc.*")), "nothing but the result is left"
    return strikes


def test_a_struck_run_ends_like_one_left_alone(whole, tmp_path):
    rounds(*whole, tmp_path, seed=1)


@pytest.mark.slow
def test_a_hundred_strikes(whole, tmp_path):
    strikes, seed = 0, 100
    while strikes < 100:
        strikes, seed = strikes + rounds(*whole, tmp_path, seed), seed + 1
    print(f"{strikes} strikes, {seed - 100} runs, none lost")
