"""Whatever the text, the answer is a case or one-line messages."""

from hypothesis import example, given
from hypothesis import strategies as st

from rodloop_cli.case import Case, parse_case
from rodloop_cli.errors import CaseError

from .broken import BROKEN, VALID

KEYS = [info.alias or name for name, info in Case.model_fields.items()]
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from([*KEYS, "mode", "random"]), inner, max_size=3)
    ),
    max_leaves=8,
)


def explanation(text, *overrides):
    """The error lines of a text."""
    try:
        parse_case(text, "case.yaml", overrides)
    except CaseError as error:
        return error.lines
    return ["accepted"]


def accepts_or_explains(text, *overrides):
    lines = explanation(text, *overrides)
    assert lines
    assert all(line.isprintable() and len(line) < 1000 for line in lines), lines


@given(st.text() | st.text(alphabet="pk:{}[]-,#&*!|>'\"%@ \n\t1.e~<?"))
@example("? [a]\n: 1")
@example("%YAML 1." + "9" * 5000)
@example('"\\ud800": "\\udfff"')
def test_any_text(text):
    accepts_or_explains(text)


@given(st.binary())
@example(b"\xff\xfe\x00")
def test_any_bytes(data):
    accepts_or_explains(data)


@given(st.dictionaries(st.sampled_from(KEYS), VALUES, max_size=4))
def test_any_value_of_a_key(values):
    # repr of plain values is close enough to flow YAML to reach every branch behind the parser.
    accepts_or_explains(VALID + "".join(f"{key}: {value!r}\n" for key, value in values.items() if key not in VALID))


@given(st.text(), st.text())
@example("p", "[" * 50)
@example("perturbation.0.mode", "9" * 40)
@example("perturbation.²", "1")
def test_any_override(key, value):
    accepts_or_explains(VALID + "perturbation: [{mode: 2, amplitude: 0.1}]\n", f"{key}={value}")


@given(st.sampled_from([text for text, _ in BROKEN.values()]), st.integers(0, 200), st.characters())
def test_broken_files_broken_further(text, position, character):
    accepts_or_explains(text[:position] + character + text[position:])
