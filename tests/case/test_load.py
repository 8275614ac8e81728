import pytest
import yaml

from rodloop_cli.case import Case, Segment, case_from, load_case, open_document, parse_case, with_value
from rodloop_cli.errors import CaseError

SHORT = "p: 3.8\nt_end: 2.5\n"


def problems(text, *overrides):
    with pytest.raises(CaseError) as refused:
        parse_case(text, "case.yaml", overrides)
    return refused.value.lines


def test_defaults_are_those_of_the_documentation():
    case = parse_case(SHORT)
    assert (case.title, case.zeta_perp, case.gamma, case.perturbation) == ("", 0, 0.5, ())
    assert (case.scheme, case.tol, case.N, case.dt) == ("radau", 1e-4, None, None)
    assert (case.stop_at, case.snapshots, case.output_points) == (("crossing",), 200, 200)


def test_the_fixed_step_scheme_has_defaults_of_its_own():
    case = parse_case(SHORT + "scheme: bdf2\n")
    assert (case.tol, case.N, case.dt) == (None, 300, 1e-3)


def test_two_segments_come_from_the_ratios():
    case = parse_case(SHORT + "stiffness_ratio: 5\ndensity_ratio: 2\nk: 0.25\n")
    assert case.segments == (Segment(fraction=0.25), Segment(fraction=0.75, stiffness=5, density=2))


def test_a_loop_of_one_material_is_one_segment():
    assert parse_case(SHORT + "k: 0.3\n").segments == (Segment(fraction=1),)


def test_segments_take_the_place_of_the_ratios():
    case = parse_case(SHORT + "segments: [{fraction: 0.5}, {fraction: 0.2, stiffness: 3}, {fraction: 0.3, density: 2}]")
    assert [segment.fraction for segment in case.segments] == [0.5, 0.2, 0.3]
    assert (case.stiffness_ratio, case.density_ratio, case.k) == (None, None, None)


def test_times_are_uniform_and_end_exactly():
    times = parse_case("p: 1\nt_end: 0.7\nsnapshots: 8\n").times
    assert times[0] == 0
    assert times[-1] == 0.7
    assert times == pytest.approx([0.1 * i for i in range(8)])


def test_given_times_are_kept():
    assert parse_case(SHORT + "snapshot_times: [0.5, 1, 2.5]\n").times == (0.5, 1, 2.5)


def test_small_numbers_are_numbers():
    assert parse_case("p: 1e-8\nt_end: 1E+1\nzeta_perp: .5\n").p == 1e-8


@pytest.mark.parametrize(
    "more",
    [
        "",
        "title: '1e-8: yes, \"no\" # \\ é 雪'\n",
        "title: yes\n",
        "title: 'null'\n",
        "stiffness_ratio: 5\nk: 0.1\n",
        "segments: [{fraction: 0.1}, {fraction: 0.9, density: 7}]\n",
        "scheme: bdf2\nN: 64\ndt: 1e-3\nstop_at: []\n",
        "N: 20\nsnapshot_times: [0, 0.1, 1]\nstop_at: [crossing, settled]\n",
        "perturbation: [{mode: 2, amplitude: 1e-8}, {random: {amplitude: 5e-5, modes: [2, 20], seed: 1}}]\n",
        "zeta_perp: -0.0\n",
    ],
)
def test_the_resolved_text_loads_as_the_same_case(more):
    case = parse_case(SHORT + more)
    again = parse_case(case.to_yaml())
    assert again == case
    assert again.to_yaml() == case.to_yaml()
    assert again.sha256 == case.sha256
    # Other programs read it with an ordinary YAML 1.1 parser.
    assert Case.model_validate(yaml.safe_load(case.to_yaml())) == case


def test_the_key_depends_on_every_value():
    keys = {parse_case(SHORT + more).sha256 for more in ("", "k: 0.4\n", "title: a\n", "tol: 1e-5\n", "stop_at: []\n")}
    assert len(keys) == 5


def test_a_case_is_built_from_keywords_by_the_same_rules():
    assert Case(p=3.8, t_end=2.5) == parse_case(SHORT)
    with pytest.raises(ValueError, match="is not used by scheme bdf2"):
        Case(p=3.8, t_end=2.5, scheme="bdf2", tol=1e-3)
    with pytest.raises(ValueError, match="frozen"):
        Case(p=3.8, t_end=2.5).p = 3


def test_a_case_is_read_from_a_file(tmp_path):
    path = tmp_path / "case.yaml"
    path.write_bytes(b"\xef\xbb\xbfp: 3.8\r\nt_end: 2.5\r\n")
    assert load_case(path) == load_case(str(path)) == parse_case(SHORT)
    assert load_case(path, ["p=4"]).p == 4


@pytest.mark.parametrize(
    ("name", "reason"),
    [("none.yaml", "no such file or directory"), (".", "is a directory"), ("a\0b", "not a file name")],
)
def test_a_file_that_cannot_be_read(tmp_path, monkeypatch, name, reason):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(CaseError) as refused:
        load_case(name)
    assert refused.value.lines == [f"{name}: cannot be read: {reason}".replace("\0", "\\x00")]


# -- overrides


def test_overrides_reach_every_key():
    text = SHORT + "perturbation:\n  - {mode: 2, amplitude: 0.1}\n"
    case = parse_case(text, "case", ["p = 1e-8", "perturbation.0.amplitude=1e-3", "stop_at=[]", "title='a=b'", "p=-2"])
    assert case.p == -2
    assert case.perturbation[0].amplitude == 1e-3
    assert (case.stop_at, case.title) == ((), "a=b")


def test_an_empty_override_removes_the_key():
    assert parse_case(SHORT + "tol: 1e-5\n", "case", ["tol=", "scheme=bdf2"]).tol is None
    assert problems(SHORT, "p=") == ["--set p=: p: is required but missing"]


def test_an_override_supplies_what_the_file_lacks():
    assert parse_case("t_end: 1\n", "case", ["p=3"]).p == 3


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("p=high", "p: must be a number (got 'high')"),
        ("gama=1", "gama: unknown key (got 1); did you mean 'gamma'?"),
        ("tol", "must be written key=value"),
        ("=3", "must be written key=value"),
        ("p=[", "not readable as YAML: expected the node content, but found '<stream end>'"),
        ("p=!!python/name:os.system", "tags (!) are not supported; write the plain value, or quote it"),
        ("p.x=3", "p: holds no keys (got 'x')"),
        ("perturbation.1.mode=3", "perturbation: is a list with items 0 to 0 (got '1')"),
        ("perturbation.0.mode=1", "perturbation.0.mode: must be at least 2 (got 1)"),
        ("perturbation=[{mode: 2, mode: 3, amplitude: 0.1}]", "0.mode: repeated key, given twice"),
        ("a.b=1", "a: unknown key (got {b: 1})"),
        (".=1", "is not a key (got '')"),
        ("tol=1\n2", "tol: must be a number (got '1 2')"),
    ],
)
def test_a_wrong_override_is_named(override, message):
    lines = problems(SHORT + "perturbation: [{mode: 2, amplitude: 0.1}]\n", override)
    assert lines == [f"--set {override}: {message}".replace("\n", "\\n")]


def test_overrides_are_reported_with_the_file_and_after_it():
    assert problems("p: x\nt_end: 1\n", "k=2", "tol=a") == [
        "case.yaml:1:1: p: must be a number (got 'x')",
        "--set k=2: k: must be at most 0.999999 (got 2)",
        "--set tol=a: tol: must be a number (got 'a')",
    ]


def test_an_override_hides_the_mistake_it_mends():
    assert parse_case("p: x\nt_end: 1\n", "case", ["p=2"]).p == 2


# -- what a sweep needs


def test_a_part_of_a_document_keeps_its_places(tmp_path):
    path = tmp_path / "sweep.yaml"
    path.write_text("base:\n  p: 3\n  t_end: x\ngrid:\n  p: [1, 2]\n")
    base = open_document(path).part(("base",))
    with pytest.raises(CaseError) as refused:
        case_from(with_value(base, "k", 7, "grid k=7"))
    assert refused.value.lines == [
        f"{path}:3:3: t_end: must be a number (got 'x')",
        "grid k=7: k: must be at most 0.999999 (got 7)",
    ]


def test_setting_a_value_leaves_the_document_alone(tmp_path):
    path = tmp_path / "case.yaml"
    path.write_text(SHORT + "perturbation: [{mode: 2, amplitude: 0.1}]\n")
    base = open_document(path)
    changed = case_from(with_value(base, "perturbation.0.mode", 3, "axis"))
    assert changed.perturbation[0].mode == 3
    assert case_from(base).perturbation[0].mode == 2
