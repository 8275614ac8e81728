import pytest

from rodloop_cli.case import parse_case
from rodloop_cli.errors import CaseError

from .broken import BROKEN, VALID


@pytest.mark.parametrize(("text", "lines"), BROKEN.values(), ids=BROKEN.keys())
def test_every_mistake_gets_its_line(text, lines):
    with pytest.raises(CaseError) as refused:
        parse_case(text, "case.yaml")
    assert refused.value.lines == lines


def test_the_table_shows_single_mistakes():
    assert parse_case(VALID).p == 3.8
    assert len(BROKEN) >= 40


def test_bytes_that_are_not_utf8_are_placed():
    with pytest.raises(CaseError, match=r"^case:2:8: is not UTF-8 text \(byte 0xff\)$"):
        parse_case(b"p: 3\ntitle: \xff\n")


def test_large_text_is_refused_unread():
    with pytest.raises(CaseError, match=r"^case: is larger than 1000000 bytes, which no case file needs$"):
        parse_case(" " * 1_000_001)


def test_many_values_are_refused():
    with pytest.raises(CaseError, match=r"more than 20000 keys and values$"):
        parse_case("snapshot_times: [" + "1, " * 30_000 + "]")


def test_a_file_of_mistakes_does_not_fill_the_screen():
    with pytest.raises(CaseError) as refused:
        parse_case("".join(f"key{i}: 1\n" for i in range(1000)))
    assert len(refused.value.lines) == 51
    assert refused.value.lines[-1] == "... and 952 more problems"
