"""Case files broken byte by byte: what is accepted, what is not explained in a line, what takes long."""

import random
import time
from dataclasses import dataclass, field
from pathlib import Path

from rodloop_cli.case import parse_case
from rodloop_cli.errors import CaseError

HOSTILE = (
    b"&a [*a, *a]", b"!!python/object/apply:os.system [echo]", b"!!binary aGk=", b"\x00", b"\xff\xfe", b"\xef\xbb\xbf",
    b"[" * 3000, b"{a: " * 500, b"9" * 5000, b"1e999", b"-.inf", b".nan", b"0x7f", b"12:30:45", b"? [a]\n: 1\n",
    b"--- \n", b"...\n", b"%YAML 9.9\n", "\u202e\u2028".encode(), b"\\UFFFFFFFF", b"<<: {p: 1}\n", b"t_end: 1\n",
)  # fmt: skip
SLOW = 10.0
"""Seconds that no input may take, on a machine however busy."""


@dataclass
class Tally:
    """Of a series of inputs."""

    tried: int = 0
    accepted: int = 0
    refused: int = 0
    wrongly_accepted: list[bytes] = field(default_factory=list)
    unexplained: list[bytes] = field(default_factory=list)
    slowest: float = 0.0


def broken(text: bytes, draw: random.Random) -> bytes:
    """The text after one to five changes: a byte flipped, a piece lost, doubled, moved, or something hostile put in."""
    for _ in range(draw.randint(1, 5)):
        at, length = draw.randrange(len(text) + 1), draw.randint(1, 12)
        piece = text[at : at + length]
        text = draw.choice(
            [
                text[:at] + bytes([draw.randrange(256)]) + text[at + 1 :],
                text[:at] + text[at + length :],
                text[:at] + piece + text[at:],
                text[:at] + draw.choice(HOSTILE) + text[at:],
                text[:at],
            ]
        )
    return text


def fuzz(seeds: list[bytes], count: int, first: int = 0) -> Tally:
    """Try so many broken inputs. Accepted wrongly: a case that its own text does not give again."""
    tally = Tally()
    for number in range(first, first + count):
        draw = random.Random(number)  # noqa: S311  nothing secret
        _try(broken(draw.choice(seeds), draw), tally)
    return tally


def _try(text: bytes, tally: Tally) -> None:
    began = time.perf_counter()
    tally.tried += 1
    try:
        case = parse_case(text)
    except CaseError as error:
        tally.refused += 1
        if not error.lines or any(not line.isprintable() or len(line) > 1000 for line in error.lines):
            tally.unexplained.append(text)
    except Exception:  # noqa: BLE001  what is looked for
        tally.unexplained.append(text)
    else:
        tally.accepted += 1
        if parse_case(case.to_yaml()) != case:
            tally.wrongly_accepted.append(text)
    tally.slowest = max(tally.slowest, time.perf_counter() - began)


def case_files() -> list[bytes]:
    """Those that come with the program."""
    return [path.read_bytes() for path in sorted(Path("configs").glob("*.yaml"))]
