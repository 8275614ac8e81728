"""How a command ends: exit codes, and lines on stderr instead of tracebacks."""

import subprocess
import sys

import click
import pytest

from rodloop_cli.cli import main, rodloop
from rodloop_cli.errors import CaseError, ConvergenceError, Interrupted, OutputError, SweepError


@pytest.fixture
def ending(monkeypatch):
    """Makes ``rodloop end`` raise an exception."""

    def prepare(exception):
        @click.command()
        def end():
            raise exception

        monkeypatch.setattr(rodloop, "get_command", lambda context, name: end)

    return prepare


@pytest.mark.parametrize(
    ("error", "code", "lines"),
    [
        (CaseError(["a: b", "c: d"]), 2, ["a: b", "c: d"]),
        (OutputError("out.nc: exists"), 2, ["out.nc: exists"]),
        (ConvergenceError("no convergence at t = 1"), 3, ["no convergence at t = 1"]),
        (SweepError("2 of 5 members failed"), 4, ["2 of 5 members failed"]),
        (Interrupted("interrupted; out.nc.part is kept"), 130, ["interrupted; out.nc.part is kept"]),
        (KeyboardInterrupt(), 130, ["interrupted"]),
        (click.Abort(), 130, ["interrupted"]),
        (click.FileError("x.nc", "gone"), 2, ["Error: Could not open file 'x.nc': gone"]),
        (BrokenPipeError(), 141, []),
        (OSError(36, "File name too long", "x.nc"), 2, ["x.nc: file name too long"]),
        (OSError("odd"), 1, ["internal error: OSError: odd; rerun with --debug for the traceback"]),
        (
            ZeroDivisionError("division\nby zero"),
            1,
            ["internal error: ZeroDivisionError: division by zero; rerun with --debug for the traceback"],
        ),
    ],
)
def test_every_error_has_its_exit_code_and_lines(ending, capsys, error, code, lines):
    ending(error)
    assert main(["end"]) == code
    shown = capsys.readouterr()
    assert (shown.out, shown.err.splitlines()) == ("", lines)


def test_debug_shows_the_traceback(ending, capsys):
    ending(ZeroDivisionError("division by zero"))
    assert main(["--debug", "end"]) == 1
    shown = capsys.readouterr().err.splitlines()
    assert shown[0].startswith("Traceback")
    assert shown[-1] == "internal error: ZeroDivisionError: division by zero"


@pytest.mark.parametrize(("value", "colored"), [("", True), ("1", False)])
def test_no_color_is_honoured(monkeypatch, capsys, value, colored):
    @click.command()
    def end():
        context = click.get_current_context()
        context.color = True if context.color is None else context.color
        click.secho("text", fg="red")

    monkeypatch.setattr(rodloop, "get_command", lambda context, name: end)
    monkeypatch.setenv("NO_COLOR", value)
    assert main(["end"]) == 0
    assert ("\x1b" in capsys.readouterr().out) is colored


def test_a_reader_that_leaves_is_no_error():
    command = f"{sys.executable} -m rodloop_cli schema | head -c 1; exit ${{PIPESTATUS[0]}}"
    ran = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert ran.stderr == ""
    # Whether the whole schema was in the pipe before its reader left is up to the machine.
    assert ran.returncode in {0, 141}
