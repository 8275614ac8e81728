"""Pictures to a movie file: gif by Pillow, html with a small player, mp4 by ffmpeg."""

from __future__ import annotations

import base64
import html
import json
import subprocess
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image

from rodloop_cli.errors import OutputError
from rodloop_cli.plot.formats import ffmpeg, format_of
from rodloop_cli.plot.moving import Movie
from rodloop_cli.plot.output import replacing

COLOURS, ALMOST_WHITE = 128, 248
"""Of the one palette for all pictures: few colours, smoothed edges."""

SHORTEST_GIF_FRAME = 20
"""Milliseconds; browsers slow shorter ones down to 100."""

_PLAYER = Path(__file__).with_name("player.html")


def save_movie(movie: Movie, path: Path, fps: float) -> None:
    """Write a movie in the format of the path's suffix, replacing what is there."""
    encoders = {"gif": _gif, "html": _html, "mp4": _mp4}
    with replacing(path) as new:
        encoders[format_of(path)](movie, new, fps)


def _gif(movie: Movie, path: Path, fps: float) -> None:
    # A gif counts time in hundredths of a second.
    duration = max(10 * round(100 / fps), SHORTEST_GIF_FRAME)
    first, *rest = _quantized(movie)
    first.save(path, format="GIF", save_all=True, append_images=rest, duration=duration, loop=0, optimize=False)


def _html(movie: Movie, path: Path, fps: float) -> None:
    pictures = [f"data:image/png;base64,{_png(picture)}" for picture in _quantized(movie)]
    page = _PLAYER.read_text(encoding="utf-8")
    for mark, text in (
        ("@TITLE@", html.escape(movie.title)),
        ("@INTERVAL@", f"{1000 / fps:.3f}"),
        ("@PICTURES@", json.dumps(pictures)),
    ):
        page = page.replace(mark, text)
    path.write_text(page, encoding="utf-8")


def _mp4(movie: Movie, path: Path, fps: float) -> None:
    program = ffmpeg()
    assert program is not None
    width, height = movie.picture(0).size
    source = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", f"{fps:g}", "-i", "-"]
    # yuv420p, which every player knows, needs even sides.
    coding = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-c:v", "libx264", "-pix_fmt", "yuv420p"]
    command = [program, "-y", "-loglevel", "error", "-threads", "1", *source, *coding, "-f", "mp4", str(path)]
    raw = b"".join(picture.tobytes() for picture in movie)
    # The program is ours or the system's, and no part of the command comes from a result file.
    ran = subprocess.run(command, input=raw, capture_output=True, check=False)  # noqa: S603
    if ran.returncode:
        said = ran.stderr.decode(errors="replace").strip().splitlines()
        raise OutputError(f"ffmpeg failed: {said[-1] if said else ran.returncode}; choose .gif or .html")


def _quantized(movie: Movie) -> list[Image.Image]:
    """All pictures on one palette, made from the first, the middle and the last."""
    sample = [movie.picture(index) for index in (0, len(movie) // 2, len(movie) - 1)]
    strip = Image.new("RGB", (sample[0].width, 3 * sample[0].height))
    for place, picture in enumerate(sample):
        strip.paste(picture, (0, place * picture.height))
    palette = _with_white(strip.quantize(COLOURS, method=Image.Quantize.MEDIANCUT))
    return [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in movie]


def _with_white(palette: Image.Image) -> Image.Image:
    """The same palette with what is almost white made white: averaging leaves the background a shade darker."""
    colours = np.array(palette.getpalette()).reshape(-1, 3)
    colours[colours.min(axis=1) >= ALMOST_WHITE] = 255
    palette.putpalette(colours.ravel().tolist())
    return palette


def _png(picture: Image.Image) -> str:
    file = BytesIO()
    picture.save(file, format="PNG")
    return base64.b64encode(file.getvalue()).decode("ascii")
