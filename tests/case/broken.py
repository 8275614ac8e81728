"""Broken case files and the one-line messages that each must produce, all of them and nothing else.

Every text is named ``case.yaml``. ``VALID`` stands for the required keys, so that a text can show one mistake only.
"""

VALID = "p: 3.8\nt_end: 2.5\n"

BROKEN: dict[str, tuple[str, list[str]]] = {
    # -- not a mapping of keys
    "empty": ("", ["case.yaml:1:1: holds no keys"]),
    "only a comment": ("# p: 3\n", ["case.yaml:1:1: holds no keys"]),
    "a list": ("- p: 3\n", ["case.yaml:1:1: must be lines of 'key: value' (got [{p: 3}])"]),
    "a word": ("p\n", ["case.yaml:1:1: must be lines of 'key: value' (got 'p')"]),
    "no space after the colon": ("p:3.8", ["case.yaml:1:1: must be lines of 'key: value' (got 'p:3.8')"]),
    # -- not YAML
    "unclosed list": (
        VALID + "stop_at: [crossing\nk: 0.5\n",
        ["case.yaml:4:2: not readable as YAML: expected ',' or ']', but got ':'"],
    ),
    "tab": (
        "p: 3\n\tt_end: 1\n",
        ["case.yaml:2:1: not readable as YAML: found character '\\t' that cannot start any token"],
    ),
    "two colons": ("p: 3: 4\n", ["case.yaml:1:5: not readable as YAML: mapping values are not allowed here"]),
    "bad indentation": (
        "p: 3\n  t_end: 1\n",
        ["case.yaml:2:8: not readable as YAML: mapping values are not allowed here"],
    ),
    "NUL": ("p: 3\nk: \0\n", ["case.yaml:2:4: character #x0000 is not allowed in YAML"]),
    "not a character": (
        VALID + 'title: "\\UFFFFFFFF"\n',
        ["case.yaml: not readable as YAML: an escape code or a version number is out of range"],
    ),
    # -- YAML that case files have no use for
    "anchor": (
        "p: &load 3\nt_end: 1\n",
        ["case.yaml:1:4: anchors (&) and aliases (*) are not supported; write the value, or quote it"],
    ),
    "alias": (
        "p: 3\nt_end: *load\n",
        ["case.yaml:2:8: anchors (&) and aliases (*) are not supported; write the value, or quote it"],
    ),
    "tag": (
        "p: !!python/object/apply:os.system ['true']\n",
        ["case.yaml:1:4: tags (!) are not supported; write the plain value, or quote it"],
    ),
    "merge key": (VALID + "<<: {k: 0.4}\n", ["case.yaml:3:1: <<: unknown key (got {k: 0.4})"]),
    "two documents": (VALID + "---\np: 4\n", ["case.yaml:4:1: holds a second YAML document; keep one"]),
    "list as a key": ("[p, t_end]: 3\n", ["case.yaml:1:1: a key must be a plain word, not a list or mapping"]),
    "deep nesting": ("p: " + "[" * 30 + "]" * 30, ["case.yaml:1:24: nested deeper than 20 levels"]),
    "huge integer": (VALID + "N: " + "9" * 31, ["case.yaml:3:4: N: an integer of more than 30 characters"]),
    # -- keys
    "unknown key": (
        VALID + "stifness_ratio: 5\n",
        ["case.yaml:3:1: stifness_ratio: unknown key (got 5); did you mean 'stiffness_ratio'?"],
    ),
    "wrong case of a key": (VALID + "n: 300\n", ["case.yaml:3:1: n: unknown key (got 300); did you mean 'N'?"]),
    "unknown key like no other": (VALID + "viscosity: 1\n", ["case.yaml:3:1: viscosity: unknown key (got 1)"]),
    "repeated key": (VALID + "p: 4\n", ["case.yaml:3:1: p: repeated key, first given in line 1"]),
    "missing keys": (
        "k: 0.5\n",
        ["case.yaml:1:1: p: is required but missing", "case.yaml:1:1: t_end: is required but missing"],
    ),
    "control characters in a key": (VALID + '"a\\nb\\e": 1\n', ["case.yaml:3:1: a\\nb\\x1b: unknown key (got 1)"]),
    # -- types
    "no value": ("p:\nt_end: 1\n", ["case.yaml:1:1: p: has no value; write one, or remove the key"]),
    "no value for an optional key": (
        VALID + "N: null\n",
        ["case.yaml:3:1: N: has no value; write one, or remove the key"],
    ),
    "text for a number": ("p: high\nt_end: 1\n", ["case.yaml:1:1: p: must be a number (got 'high')"]),
    "quoted number": ("p: '3.8'\nt_end: 1\n", ["case.yaml:1:1: p: must be a number (got '3.8')"]),
    "boolean for a number": ("p: true\nt_end: 1\n", ["case.yaml:1:1: p: must be a number (got true)"]),
    "YAML 1.1 boolean": ("p: yes\nt_end: 1\n", ["case.yaml:1:1: p: must be a number (got 'yes')"]),
    "sexagesimal": ("p: 3\nt_end: 12:30:45\n", ["case.yaml:2:1: t_end: must be a number (got '12:30:45')"]),
    "date": ("p: 3\nt_end: 2024-01-01\n", ["case.yaml:2:1: t_end: must be a number (got '2024-01-01')"]),
    "thousands": ("p: 1_000\nt_end: 1\n", ["case.yaml:1:1: p: must be a number (got '1_000')"]),
    "a list for a number": ("p: [3, 4]\nt_end: 1\n", ["case.yaml:1:1: p: must be a number (got [3, 4])"]),
    "infinite": ("p: .inf\nt_end: 1\n", ["case.yaml:1:1: p: must be a finite number (got inf)"]),
    "not a number": ("p: .nan\nt_end: 1\n", ["case.yaml:1:1: p: must be a finite number (got nan)"]),
    "overflow": ("p: 1e400\nt_end: 1\n", ["case.yaml:1:1: p: must be a finite number (got inf)"]),
    "fraction for a count": (VALID + "N: 30.5\n", ["case.yaml:3:1: N: must be a whole number (got 30.5)"]),
    "number for text": (VALID + "title: 9\n", ["case.yaml:3:1: title: must be text; put it in quotes (got 9)"]),
    "two-line title": (
        VALID + 'title: "a\\nb"\n',
        ["case.yaml:3:1: title: must be one line without control characters (got 'a\\nb')"],
    ),
    "word for a list": (
        VALID + "stop_at: crossing\n",
        ["case.yaml:3:1: stop_at: must be a list, in square brackets or one '- item' a line (got 'crossing')"],
    ),
    "number for a mapping": (
        VALID + "perturbation: [3]\n",
        ["case.yaml:3:16: perturbation.0: must be a mapping, {key: value, ...} (got 3)"],
    ),
    "mapping for a list": (
        VALID + "perturbation: {mode: 2, amplitude: 0.1}\n",
        [
            (
                "case.yaml:3:1: perturbation: must be a list, in square brackets or one '- item' a line "
                "(got {mode: 2, amplitude: 0.1})"
            )
        ],
    ),
    # -- ranges
    "negative stiffness": (
        VALID + "stiffness_ratio: -5\n",
        ["case.yaml:3:1: stiffness_ratio: must be at least 1e-09 (got -5)"],
    ),
    "no density": (VALID + "density_ratio: 0\n", ["case.yaml:3:1: density_ratio: must be at least 1e-09 (got 0)"]),
    "k of the whole loop": (VALID + "k: 1\n", ["case.yaml:3:1: k: must be at most 0.999999 (got 1)"]),
    "negative drag": (VALID + "zeta_perp: -1e-8\n", ["case.yaml:3:1: zeta_perp: must be at least 0 (got -1e-08)"]),
    "time going back": ("p: 3\nt_end: -1\n", ["case.yaml:2:1: t_end: must be at least 1e-09 (got -1)"]),
    "no tolerance": (VALID + "tol: 0\n", ["case.yaml:3:1: tol: must be at least 1e-12 (got 0)"]),
    "memory bomb in N": (VALID + "N: 1000000000\n", ["case.yaml:3:1: N: must be at most 100000 (got 1000000000)"]),
    "memory bomb in snapshots": (
        VALID + "snapshots: 1000000000\n",
        ["case.yaml:3:1: snapshots: must be at most 100000 (got 1000000000)"],
    ),
    "one snapshot": (VALID + "snapshots: 1\n", ["case.yaml:3:1: snapshots: must be at least 2 (got 1)"]),
    "large file": (
        VALID + "snapshots: 100000\noutput_points: 1000\n",
        [
            (
                "case.yaml:4:1: output_points: 100000 stored times of 1000 points are more than 10000000 values "
                "a variable (got 1000)"
            )
        ],
    ),
    # -- choices
    "unknown scheme": (
        VALID + "scheme: bfd2\n",
        ["case.yaml:3:1: scheme: must be radau or bdf2 (got 'bfd2'); did you mean 'bdf2'?"],
    ),
    "unknown event": (
        VALID + "stop_at: [setled]\n",
        ["case.yaml:3:11: stop_at.0: must be crossing or settled (got 'setled'); did you mean 'settled'?"],
    ),
    # -- perturbation
    "translation as a mode": (
        VALID + "perturbation:\n  - {mode: 1, amplitude: 0.1}\n",
        ["case.yaml:4:6: perturbation.0.mode: must be at least 2 (got 1)"],
    ),
    "incomplete mode": (
        VALID + "perturbation:\n  - {mod: 2, amplitude: 0.1}\n",
        [
            "case.yaml:4:5: perturbation.0.mode: is required but missing",
            "case.yaml:4:6: perturbation.0.mod: unknown key (got 2); did you mean 'mode'?",
        ],
    ),
    "large amplitudes": (
        VALID + "perturbation:\n  - {mode: 2, amplitude: 0.3}\n  - {mode: 3, amplitude: -0.2}\n",
        ["case.yaml:3:1: perturbation: amplitudes must sum to less than 0.5 (got 0.5)"],
    ),
    "modes backwards": (
        VALID + "perturbation:\n  - random: {amplitude: 1e-5, modes: [20, 2], seed: 1}\n",
        ["case.yaml:4:31: perturbation.0.random.modes: the first mode must not exceed the last (got [20, 2])"],
    ),
    "one mode of a range": (
        VALID + "perturbation:\n  - random: {amplitude: 1e-5, modes: [2]}\n",
        ["case.yaml:4:31: perturbation.0.random.modes.1: is required but missing"],
    ),
    "negative seed": (
        VALID + "perturbation:\n  - random: {amplitude: 1e-5, modes: [2, 20], seed: -1}\n",
        ["case.yaml:4:47: perturbation.0.random.seed: must be at least 0 (got -1)"],
    ),
    "random and mode in one": (
        VALID + "perturbation:\n  - {mode: 2, random: {amplitude: 1e-5, modes: [2, 20]}}\n",
        ["case.yaml:4:6: perturbation.0.mode: does not go with the other keys here (got 2)"],
    ),
    "unresolved mode": (
        VALID + "scheme: bdf2\nN: 30\nperturbation: [{mode: 16, amplitude: 0.01}]\n",
        ["case.yaml:5:17: perturbation.0.mode: needs N of at least 32 (N is 30) (got 16)"],
    ),
    # -- segments
    "segments and a ratio": (
        VALID + "k: 0.4\nsegments: [{fraction: 1}]\n",
        ["case.yaml:3:1: k: cannot be combined with segments; remove one of the two (got 0.4)"],
    ),
    "no segments": (VALID + "segments: []\n", ["case.yaml:3:1: segments: must not be empty; remove the key (got [])"]),
    "open loop": (
        VALID + "segments:\n  - {fraction: 0.5}\n  - {fraction: 0.4, stiffness: 5}\n",
        ["case.yaml:3:1: segments: fractions must sum to 1 within 1e-09 (got 0.9)"],
    ),
    "absolute stiffnesses": (
        VALID + "segments:\n  - {fraction: 0.5, stiffness: 2}\n  - {fraction: 0.5, stiffness: 5}\n",
        [
            (
                "case.yaml:4:21: segments.0.stiffness: must be 1 in the first segment, the unit of the others; "
                "divide every stiffness by 2 (got 2)"
            )
        ],
    ),
    "segment without a length": (
        VALID + "segments: [{stiffness: 1}]\n",
        ["case.yaml:3:12: segments.0.fraction: is required but missing"],
    ),
    "fewer cells than segments": (
        VALID + "N: 4\nsegments: [" + "{fraction: 0.2}, " * 5 + "]\n",
        ["case.yaml:3:1: N: must be at least the number of segments, 5 (got 4)"],
    ),
    # -- keys that do not go together
    "tolerance of the fixed step": (
        VALID + "scheme: bdf2\ntol: 1e-5\n",
        ["case.yaml:4:1: tol: is not used by scheme bdf2, whose accuracy N and dt set; remove it (got 1e-05)"],
    ),
    "step longer than the run": (
        VALID + "scheme: bdf2\ndt: 3\n",
        ["case.yaml:4:1: dt: the step dt = 3 must not exceed t_end = 2.5 (got 3)"],
    ),
    "too many steps": (
        VALID + "dt: 1e-9\n",
        ["case.yaml:3:1: dt: t_end = 2.5 in steps of dt = 1e-09 is more than 10000000 steps (got 1e-09)"],
    ),
    "too many default steps": (
        "p: 3\nt_end: 1e5\nscheme: bdf2\n",
        ["case.yaml:2:1: t_end: t_end = 100000 in steps of dt = 0.001 is more than 10000000 steps (got 100000)"],
    ),
    "snapshots twice": (
        VALID + "snapshots: 10\nsnapshot_times: [0, 1]\n",
        ["case.yaml:3:1: snapshots: cannot be combined with snapshot_times; remove one of the two (got 10)"],
    ),
    "times not increasing": (
        VALID + "snapshot_times: [0, 1, 1]\n",
        ["case.yaml:3:24: snapshot_times.2: must be greater than the time before it, 1 (got 1)"],
    ),
    "time after the end": (
        VALID + "snapshot_times:\n  - 0\n  - 2.6\n",
        ["case.yaml:5:5: snapshot_times.1: must not exceed t_end = 2.5 (got 2.6)"],
    ),
    # -- all at once, in the order of the file
    "many mistakes": (
        "p: x\nstiffness_ratio: 0\ngama: 1\nk: 0.5\nk: 0.6\nscheme: bdf2\ntol: 1\nsnapshots: 5\nsnapshot_times: [0]\n",
        [
            "case.yaml:1:1: p: must be a number (got 'x')",
            "case.yaml:1:1: t_end: is required but missing",
            "case.yaml:2:1: stiffness_ratio: must be at least 1e-09 (got 0)",
            "case.yaml:3:1: gama: unknown key (got 1); did you mean 'gamma'?",
            "case.yaml:5:1: k: repeated key, first given in line 4",
            "case.yaml:7:1: tol: must be at most 0.1 (got 1)",
            ("case.yaml:8:1: snapshots: cannot be combined with snapshot_times; remove one of the two (got 5)"),
        ],
    ),
}
