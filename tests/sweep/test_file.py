"""Sweep files: what they mean, and what is said of wrong ones."""

import pytest

from rodloop_cli.errors import CaseError
from rodloop_cli.sweep.file import read_sweep
from rodloop_cli.sweep.plan import Shard, planned


def plan_of(path, overrides=(), shard=None):
    return planned(read_sweep(str(path), overrides), shard)


def problems_of(path, overrides=()):
    with pytest.raises(CaseError) as caught:
        plan_of(path, overrides)
    return [line.removeprefix(f"{path.parent}/") for line in caught.value.problems]


def points(path, axis=0):
    return [point[0] for point in read_sweep(str(path)).axes[axis].points]


def test_spaced_values_include_both_ends_and_are_clean(sweep_file):
    assert points(sweep_file("p: {linspace: [0, 1, 11]}"))[3] == 0.3
    assert points(sweep_file("p: {logspace: [16, 128, 4]}")) == [16, 32, 64, 128]
    assert points(sweep_file("p: {logspace: [-100, -1, 3]}")) == [-100, -10, -1]


def test_whole_numbers_stay_whole_for_keys_that_need_them(sweep_file):
    plan = plan_of(sweep_file("snapshots: {linspace: [10, 30, 3]}"))
    assert [member.name for member in plan.members] == ["snapshots=10", "snapshots=20", "snapshots=30"]


def test_members_are_the_product_in_order_with_zip_as_last_axis(sweep_file):
    path = sweep_file("p: [4, 8]; k: [0.3, 0.5]", more="zip: {t_end: [0.01, 0.02]}")
    plan = plan_of(path)
    assert plan.shape == (2, 2, 2)
    assert [m.name for m in plan.members[:3]] == [
        "p=4_k=0.3_t_end=0.01",
        "p=4_k=0.3_t_end=0.02",
        "p=4_k=0.5_t_end=0.01",
    ]
    assert len({m.key for m in plan.members}) == 8


def test_the_base_can_be_a_file_beside_the_sweep_file(tmp_path):
    (tmp_path / "cases").mkdir()
    (tmp_path / "case.yaml").write_text("p: 3\nt_end: 1\ndensity_ratio: 2\n")
    path = tmp_path / "cases" / "grid.yaml"
    path.write_text("base: ../case.yaml\ngrid: {p: [4, 8]}\n")
    assert plan_of(path).values(plan_of(path).members[1]) == {"p": 8, "t_end": 1, "density_ratio": 2}


def test_inner_keys_can_be_varied(sweep_file):
    path = sweep_file("perturbation.0.amplitude: [1e-3, 1e-2]", base="p: 4, perturbation: [{mode: 2, amplitude: 0}]")
    plan = plan_of(path)
    assert plan.values(plan.members[0])["perturbation"] == [{"mode": 2, "amplitude": 1e-3}]
    assert plan.members[0].name == "perturbation.0.amplitude=0.001"


def test_overrides_reach_the_base_and_the_grid(sweep_file):
    plan = plan_of(sweep_file(), ["grid.p=[1, 2, 3]", "t_end=0.5", "output=scalars"])
    assert [member.name for member in plan.members] == ["p=1", "p=2", "p=3"]
    assert plan.values(plan.members[0])["t_end"] == 0.5
    assert not plan.sweep.keeps_fields


def test_lists_and_odd_texts_have_short_names(sweep_file):
    path = sweep_file("stop_at: [[], [crossing]]; scheme: [radau]; title: [a/b, c]")
    names = [member.name for member in plan_of(path).members]
    assert len(set(names)) == 4
    assert all("/" not in name and "[" not in name for name in names)


NUMBERS = "must be three numbers, [first value, last value, number of values]"


def test_every_problem_is_told_once_with_its_place(sweep_file):
    path = sweep_file("p: [4, 1e99, x]; stifness_ratio: [1, 2]; gamma: {linspace: [0, 1]}", base="t_end: 1, kk: 3")
    path.write_text(path.read_text().replace(", t_end: 0.02", "") + "outptu: fields\n")
    assert problems_of(path) == [
        "grid.yaml:4:3: grid.stifness_ratio: not a key of a case; did you mean 'stiffness_ratio'?",
        f"grid.yaml:5:11: grid.gamma.linspace: {NUMBERS} (got [0, 1])",
        "grid.yaml:7:1: outptu: unknown key in a sweep file; did you mean 'output'?",
        "grid.yaml:1:18: kk: unknown key (got 3); did you mean 'k'?",
        "grid.yaml:3:10: p: must be at most 1000000000 (got 1e+99)",
        "grid.yaml:3:16: p: must be a number (got 'x')",
    ]


SPACING = "must be a list, {linspace: [a, b, n]} or {logspace: [a, b, n]}"
ITEMS = "must be a list, in square brackets or one '- item' a line"
MOVE = "a key of the case belongs in base, or in grid with a list of values"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "1:1: grid: is required but missing (or zip)"),
        ("grid: 4", "2:1: grid: must be a mapping of keys to values (got 4)"),
        ("grid: {p: []}", "2:8: grid.p: must not be empty; remove the key"),
        ("grid: {p: [1, ]}\nzip: {k: [~]}", "3:11: zip.k.0: has no value; write one, or remove the item"),
        ("grid: {p: [1, 1.0]}", "2:15: grid.p.1: repeats an earlier value (got 1)"),
        ("grid: {p: 3}", f"2:8: grid.p: {SPACING} (got 3)"),
        ("grid: {p: {logspac: [1, 2, 3]}}", "2:12: grid.p.logspac: unknown spacing, must be linspace or logspace"),
        ("grid: {p: {linspace: [1, 2, 1]}}", "2:12: grid.p.linspace: the number of values must be a whole number"),
        ("grid: {p: {linspace: [1, 1, 3]}}", "2:12: grid.p.linspace: the first and the last value must differ"),
        ("grid: {p: {logspace: [-1, 1, 3]}}", "2:12: grid.p.logspace: the end values must both be positive or both"),
        ("grid: {p: [1]}\nzip: {p: [2]}", "3:7: zip.p: is varied by grid as well; remove one of the two"),
        ("zip: {p: [1, 2], k: [0.5]}", "2:18: zip.k: must have as many values as p, 2 (got 1)"),
        ("p: [1, 2]", f"2:1: p: unknown key in a sweep file; {MOVE}"),
        (
            "grid: {p: [1]}\noutput: field",
            "3:1: output: must be fields or scalars (got 'field'); did you mean 'fields'?",
        ),
        ("grid: {perturbation.0.mode: [3]}", f"2:30: perturbation: {ITEMS} (got {{0: {{mode: 3}}}})"),
        ("grid: {title.x: [3]}", "2:18: title: holds no keys (got 'x')"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(tmp_path, text, expected):
    path = tmp_path / "grid.yaml"
    path.write_text("base: {p: 1, t_end: 1, title: t}\n" + text + "\n")
    assert any(line.startswith(f"grid.yaml:{expected}") for line in problems_of(path)), problems_of(path)


def test_a_file_without_keys_or_base_is_refused(tmp_path):
    path = tmp_path / "grid.yaml"
    path.write_text("- 3\n")
    assert problems_of(path) == ["grid.yaml:1:1: must be lines of 'key: value' with base and grid (got [3])"]
    path.write_text("grid: {p: [1]}\n")
    assert problems_of(path) == ["grid.yaml:1:1: base: is required but missing"]


def test_a_pair_of_values_that_do_not_go_together_is_found(sweep_file):
    path = sweep_file("N: [4, 40]; perturbation.0.mode: [2, 20]", base="p: 4, perturbation: [{mode: 2, amplitude: 0}]")
    assert problems_of(path) == [
        "grid.yaml:4:28: perturbation.0.mode: needs N of at least 40 (N is 4) (got 20)",
    ]


def test_a_base_that_cannot_be_read_is_named(tmp_path):
    path = tmp_path / "grid.yaml"
    path.write_text("base: none.yaml\ngrid: {p: [1]}\n")
    assert problems_of(path) == ["none.yaml: cannot be read: no such file or directory"]


def test_too_many_members_are_refused(sweep_file, monkeypatch):
    monkeypatch.setattr("rodloop_cli.sweep.file.MOST_MEMBERS", 5)
    assert problems_of(sweep_file("p: [1, 2, 3]; k: [0.3, 0.5]")) == ["grid.yaml:2:1: grid: has 6 members, more than 5"]


def test_shards_share_the_members_without_overlap(sweep_file):
    path = sweep_file("p: {linspace: [1, 7, 7]}")
    shards = [plan_of(path, shard=Shard(i, 3)).members for i in (1, 2, 3)]
    assert sorted(m.name for members in shards for m in members) == [f"p={i}" for i in range(1, 8)]


def test_the_key_depends_on_the_resolved_case_alone(sweep_file):
    plain = plan_of(sweep_file())
    spelled = plan_of(sweep_file("p: [4.0, 8.0]", base="p: 3, gamma: 0.5"))
    assert [m.key for m in plain.members] == [m.key for m in spelled.members]
