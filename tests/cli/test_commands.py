import json
import logging
import re
import subprocess
import sys
from importlib.resources import files

import pytest
from click.testing import CliRunner

from rodloop_cli import __version__
from rodloop_cli.case import parse_case
from rodloop_cli.cli import COMMANDS, main, rodloop

SHORT = "p: 3.8\nt_end: 2.5\n"


@pytest.fixture
def case_file(tmp_path):
    path = tmp_path / "case.yaml"
    path.write_text(SHORT)
    return path


# -- help


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(command, capsys):
    assert main([command, "-h"]) == 0
    shown = capsys.readouterr().out
    assert shown.startswith(f"Usage: rodloop {command} ")
    assert all(option in shown for option in ("--verbose", "--quiet", "--debug", "--help"))


def test_the_help_lists_every_command(capsys):
    assert main(["--help"]) == 0
    shown = capsys.readouterr().out
    assert all(
        re.search(rf"^  {name} +{re.escape(entry.help)}$", shown, re.MULTILINE) for name, entry in COMMANDS.items()
    )


@pytest.mark.parametrize("arguments", [["--help"], ["--version"], ["check", "-h"], ["new", "-h"], ["schema", "-h"]])
def test_help_loads_nothing_heavy(arguments):
    code = (
        f"import sys; from rodloop_cli.cli import main; assert main({arguments}) == 0\n"
        "heavy = {'numpy', 'scipy', 'xarray', 'matplotlib', 'pydantic', 'yaml', 'netCDF4', 'pandas'}\n"
        "sys.exit(' '.join(heavy & set(sys.modules)) or 0)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (0, "")


def test_without_a_command_the_help_is_shown(capsys):
    assert main([]) == 2
    assert "Commands:" in capsys.readouterr().err


def test_the_version_is_shown(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"rodloop, version {__version__}\n"


def test_a_misspelt_command_is_a_usage_error(capsys):
    assert main(["chek"]) == 2
    assert "No such command 'chek'" in capsys.readouterr().err


def test_module_is_the_command():
    ran = subprocess.run([sys.executable, "-m", "rodloop_cli", "--version"], capture_output=True, text=True, check=True)
    assert ran.stdout == f"rodloop, version {__version__}\n"


@pytest.mark.parametrize(
    ("words", "expected"), [("rodloop ch", "check"), ("rodloop check --s", "--set"), ("rodloop --ver", "--version")]
)
def test_the_shell_completes(words, expected):
    environment = {"_RODLOOP_COMPLETE": "bash_complete", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    shown = CliRunner(env=environment).invoke(rodloop, prog_name="rodloop").output
    assert expected in [line.partition(",")[2] for line in shown.splitlines()]


def test_a_command_that_is_not_installed_is_a_usage_error(monkeypatch, capsys):
    monkeypatch.setitem(COMMANDS, "gone", COMMANDS["check"]._replace(target="rodloop_cli.cli.gone:gone"))
    assert main(["gone"]) == 2
    assert "'gone' is not part of this installation" in capsys.readouterr().err


# -- check


def test_check_shows_the_case_with_its_defaults(case_file, capsys):
    assert main(["check", str(case_file), "--set", "stiffness_ratio=5"]) == 0
    shown = capsys.readouterr().out
    assert parse_case(shown) == parse_case(SHORT + "stiffness_ratio: 5")
    assert "# segment 2: 0.5 of the loop, stiffness 5, density 1" in shown


def test_check_lists_every_mistake_and_nothing_else(case_file, capsys):
    case_file.write_text("p: x\n")
    assert main(["check", str(case_file), "--set", "N=1"]) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.splitlines() == [
        f"{case_file}:1:1: p: must be a number (got 'x')",
        f"{case_file}:1:1: t_end: is required but missing",
        "--set N=1: N: must be at least 4 (got 1)",
    ]


@pytest.mark.parametrize("name", ["quickstart.yaml"])
def test_configs_are_valid(name, pytestconfig):
    assert main(["check", str(pytestconfig.rootpath / "configs" / name)]) == 0


# -- new


def test_new_writes_a_case_that_checks(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["new"]) == 0
    assert capsys.readouterr().out == "case.yaml\n"
    assert main(["check", "case.yaml"]) == 0


def test_new_does_not_overwrite(case_file, capsys):
    assert main(["new", str(case_file)]) == 2
    assert capsys.readouterr().err == f"{case_file}: exists already; use another name, or -f to overwrite it\n"
    assert case_file.read_text() == SHORT
    assert main(["new", "-f", str(case_file)]) == 0
    assert case_file.read_text() == template()


def test_new_to_stdout_and_to_nowhere(tmp_path, capsys):
    assert main(["new", "-"]) == 0
    assert capsys.readouterr().out == template()
    assert main(["new", str(tmp_path / "none" / "case.yaml")]) == 2
    assert capsys.readouterr().err.endswith("case.yaml: cannot be written: no such file or directory\n")


def test_the_template_shows_every_key_and_its_comments_are_valid_too():
    keys = schema()["properties"]
    assert all(re.search(rf"^#? ?{key}:|snapshot_times:", template(), re.MULTILINE) for key in keys)
    segments = parse_case(uncommented(template(), "segments") + SHORT).segments
    assert [segment.stiffness for segment in segments] == [1, 5, 2]


def template():
    return files("rodloop_cli.case").joinpath("template.yaml").read_text()


def uncommented(text, key):
    lines = [line.removeprefix("# ") for line in text.splitlines()]
    start = next(i for i, line in enumerate(lines) if line == f"{key}:")
    return "\n".join([lines[start], *(line for line in lines[start + 1 :][:3])]) + "\n"


# -- schema


def schema():
    shown = CliRunner().invoke(rodloop, ["schema"])
    assert shown.exit_code == 0
    return json.loads(shown.output)


def test_the_schema_describes_every_key():
    shown = schema()
    assert shown["required"] == ["p", "t_end"]
    assert shown["additionalProperties"] is False
    for model in (shown, *shown["$defs"].values()):
        assert all("description" in entry for entry in model["properties"].values())


def test_the_schema_gives_the_defaults_and_no_null():
    keys = schema()["properties"]
    assert (keys["tol"]["default"], keys["k"]["default"], keys["stop_at"]["default"]) == (1e-4, 0.5, ["crossing"])
    without_default = {key for key, entry in keys.items() if "default" not in entry}
    assert without_default == {"p", "t_end", "N", "dt", "segments", "snapshot_times", "scales"}
    assert "null" not in json.dumps(keys)


# -- how much is said


@pytest.mark.parametrize(
    ("before", "after", "level"),
    [([], [], "WARNING"), (["-v"], [], "INFO"), ([], ["-v"], "INFO"), (["-v"], ["-v"], "DEBUG"), ([], ["-q"], "ERROR")],
)
def test_verbosity_is_given_before_or_after_the_command(case_file, before, after, level, capsys):
    assert main([*before, "check", str(case_file), *after]) == 0
    assert logging.getLevelName(logging.getLogger("rodloop_cli").level) == level
