"""From a file to a file, through the command line."""

import re
import subprocess
import sys
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from PIL import Image

from rodloop_cli.cli import main
from rodloop_cli.plot import formats
from rodloop_cli.plot.kinds import CONTENTS, MOVIE, RUN

FIGURES = [kind for kind in CONTENTS[RUN].kinds if kind != MOVIE]
SMALL = ["--dpi", "30"]


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def refused(capsys):
    """Runs the command and gives the one line it must say."""

    def run(*arguments):
        assert main(["plot", *map(str, arguments)]) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert err.count("\n") == 1, err
        return err.strip()

    return run


@pytest.mark.parametrize("kind", FIGURES)
def test_every_kind_makes_a_figure(kind, crossing_file, here, capsys):
    assert main(["plot", str(crossing_file), "--kind", kind, "-o", "out.png", *SMALL]) == 0
    assert capsys.readouterr() == ("out.png\n", "")
    with Image.open(here / "out.png") as picture:
        assert min(picture.size) > 100
    assert [path.name for path in here.iterdir()] == ["out.png"]


def test_the_default_is_an_overview_named_after_the_file(damped_file, here, capsys):
    assert main(["plot", str(damped_file), *SMALL]) == 0
    assert capsys.readouterr() == ("damped.png\n", "")
    with Image.open(here / "damped.png") as picture:
        assert picture.width == 390


def test_svg_is_the_same_every_time(damped_file, here):
    for name in ("a.svg", "b.svg"):
        assert main(["plot", str(damped_file), "--kind", "curvature", "-o", name]) == 0
    assert (here / "a.svg").read_bytes() == (here / "b.svg").read_bytes()
    ET.parse(here / "a.svg")


def test_pdf(damped_file, here):
    assert main(["plot", str(damped_file), "--kind", "curvature", "-o", "a.PDF"]) == 0
    written = (here / "a.PDF").read_bytes()
    assert written.startswith(b"%PDF")
    assert b"CreationDate" not in written


def test_an_older_figure_is_replaced(damped_file, here):
    (here / "out.png").write_text("old")
    assert main(["plot", str(damped_file), "--kind", "curvature", "-o", "out.png", *SMALL]) == 0
    assert (here / "out.png").stat().st_size > 1000


def test_asked_times_are_told(damped_file, capsys):
    assert main(["plot", str(damped_file), "--kind", "curvature", "--times", "0,.5,2", *SMALL]) == 0
    assert "stored times nearest to those asked for: 0, 0.461538, 1" in capsys.readouterr().err
    assert main(["plot", str(damped_file), "--kind", "curvature", "--times", "0.5", "-q", *SMALL]) == 0
    assert capsys.readouterr().err == ""


def test_size_and_dpi(damped_file, here):
    assert main(["plot", str(damped_file), "--kind", "curvature", "--size", "6x4", "--dpi", "40"]) == 0
    with Image.open(here / "damped.png") as picture:
        assert picture.size == (240, 160)


def test_a_gif_has_a_frame_for_each_stored_time(crossing_file, here):
    assert main(["plot", str(crossing_file), "--kind", "movie", "--fps", "10", "--dpi", "40"]) == 0
    with Image.open(here / "crossing.gif") as picture:
        assert picture.n_frames == 14
        assert picture.info["duration"] == 100
        assert picture.convert("RGB").getpixel((1, 1)) == (255, 255, 255)
    assert [path.name for path in here.iterdir()] == ["crossing.gif"]


def test_an_html_movie_needs_nothing_else(damped_file, here):
    assert main(["plot", str(damped_file), "-o", "m.html", "--times", "0,0.5,1", "--dpi", "40"]) == 0
    page = (here / "m.html").read_text()
    assert page.count("data:image/png;base64,") == 3
    assert not re.search(r"https?:|src=|href=|@[A-Z]+@", page)
    assert "<title>Costs $5</title>" in page


def test_mp4_without_ffmpeg_says_how_to_get_it(damped_file, refused, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    monkeypatch.setenv("PATH", "")
    assert refused(damped_file, "-o", "m.mp4") == (
        "m.mp4: mp4 needs ffmpeg: pip install 'rodloop[movie]', or choose .gif or .html"
    )


@pytest.mark.skipif(formats.ffmpeg() is None, reason="no ffmpeg here")
def test_mp4(damped_file, here):
    assert main(["plot", str(damped_file), "-o", "m.mp4", "--dpi", "41"]) == 0
    assert (here / "m.mp4").read_bytes()[4:8] == b"ftyp"


def test_a_failing_ffmpeg_leaves_no_file(damped_file, here, refused, monkeypatch):
    program = here / "ffmpeg"
    program.write_text("#!/bin/sh\ncat > /dev/null\necho no codec >&2\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setattr("rodloop_cli.plot.encode.ffmpeg", lambda: str(program))
    monkeypatch.setattr(formats, "ffmpeg", lambda: str(program))
    assert refused(damped_file, "-o", "m.mp4", "--dpi", "20") == "ffmpeg failed: no codec; choose .gif or .html"
    assert [path.name for path in here.iterdir()] == ["ffmpeg"]


# -- what is refused


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--kind", "shaeps"], "--kind: unknown kind 'shaeps'; did you mean 'shapes'?"),
        (["--kind", "zzz"], "; choose from overview, shapes, "),
        (["-o", "x.pgn"], "x.pgn: unknown format 'pgn'; did you mean 'png'?"),
        (["-o", "x"], "x: unknown format '' (figures: png, svg, pdf; movies: gif, mp4, html)"),
        (["--kind", "shapes", "-o", "x.gif"], "x.gif: this kind cannot be written as gif; choose from png, svg, pdf"),
        (["--kind", "movie", "-o", "x.png"], "x.png: this kind cannot be written as png"),
        (["-o", "no/where/x.png"], "no folder no/where"),
        (["--times", "0,now"], "--times: must be numbers with commas between them, as in 0,0.5,1 (got 'now')"),
        (["--times", "nan"], "--times: must be numbers"),
        (["--times", ",".join("1" * 1001)], "--times: at most 1000 times can be drawn (got 1001)"),
        (["--size", "8"], "--size: must be width x height in inches, as in 8x5 (got '8')"),
        (["--size", "8xinf"], "--size: must be width x height"),
        (["--size", "1000x5"], "--size: must be between 1 and 100 (got 1000)"),
        (["--size", "90x90", "--dpi", "2000"], "make more than 2e+08 pixels"),
        (["--size", "1x1"], "--size: too small for what must be drawn"),
        (["--dpi", "0"], "--dpi: must be between 10 and 2400 (got 0)"),
        (["--fps", "nan"], "--fps: must be between 0.1 and 100 (got nan)"),
    ],
)
def test_wrong_wishes(crossing_file, refused, arguments, words):
    assert words in refused(crossing_file, *arguments)


def test_missing_and_foreign_files(here, refused):
    (here / "text.nc").write_text("hello")
    assert refused("gone.nc") == "gone.nc: no such file"
    assert refused("text.nc") == "text.nc is not a netCDF-4 file"
    (here / "folder.nc").mkdir()
    assert refused("folder.nc") == "folder.nc is a folder, not a result file"


def test_a_folder_that_is_not_writable(damped_file, here, refused, monkeypatch):
    def forbidden(self, data):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("pathlib.Path.write_bytes", forbidden)
    assert "x.png: no permission to write in ." in refused(damped_file, "-o", "x.png", "--kind", "curvature", *SMALL)


# -- damaged and hostile files


@pytest.mark.parametrize(
    ("name", "values", "words"),
    [
        ("x", np.nan, "x holds numbers that are not finite or too large"),
        ("y", 1e300, "y holds numbers that are not finite or too large"),
        ("axial_force", np.inf, "axial_force holds numbers"),
        ("bending_energy", np.nan, "bending_energy holds numbers"),
        ("segment", 0, "segment does not count 1, 2, ... along s"),
        ("segment", 2_000_000_000, "segment does not count"),
        ("segment", np.arange(48, 0, -1), "segment does not count"),
        ("s", np.arange(48.0), "s does not increase within [0, 2 pi)"),
        ("s", np.zeros(48), "s does not increase"),
    ],
)
def test_numbers_that_cannot_be_drawn(changed, refused, name, values, words):
    path = changed(name, values)
    assert refused(path).startswith(f"{path}: {words}")


@pytest.mark.parametrize(
    "attributes",
    [
        {"title": "$x_{\\frac"},
        {"title": "\x1b[31m\n$\\\\$"},
        {"title": "環の運動"},
        {"title": np.arange(3)},
        {"title": "long " * 2000},
        {"title": ""},
        {"outcome": "$\\"},
        {"outcome": None},
        {"outcome": "the step fell below its minimum " * 9},
        {"case": "&a [*a, *a]"},
        {"case": None},
        {"first_crossing_time": "soon"},
        {"first_crossing_time": np.nan},
    ],
    ids=lambda attributes: repr(attributes)[:30],
)
def test_attributes_are_only_words(changed, attributes):
    path = str(changed(**attributes))
    assert main(["plot", "-q", path, "--kind", "displacement", "-o", "out.png", *SMALL]) == 0


@pytest.mark.parametrize("content", ["dance", "modes"])
def test_a_file_of_another_sort(changed, refused, content):
    assert content in refused(changed(rodloop_content=content))


def test_an_unfinished_run_is_drawn_and_says_so(changed, here, capsys):
    part = changed("t", np.append(np.linspace(0, 0.3, 9), np.full(5, np.nan)), "killed.nc.part", outcome=None)
    for path in (part, part.with_name("killed.nc")):
        assert main(["plot", str(path), "--kind", "curvature", *SMALL]) == 0
        assert capsys.readouterr() == ("killed.png\n", "")


def test_the_help_lists_the_kinds_of_every_sort_of_file(capsys):
    assert main(["plot", "--help"]) == 0
    description = capsys.readouterr().out.partition("Options:")[0]
    listed = [line.split(None, 1) for line in description.splitlines() if line.startswith("    ")]
    assert listed == [[name, kind.words] for content in CONTENTS.values() for name, kind in content.kinds.items()]


def test_help_needs_nothing_heavy():
    code = (
        "import sys; from rodloop_cli.cli import main; assert main(['plot', '-h']) == 0\n"
        "sys.exit(' '.join({'numpy', 'xarray', 'matplotlib', 'netCDF4', 'PIL'} & set(sys.modules)) or 0)"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stderr) == (0, "")
