"""Plain values to YAML text."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import yaml

from rodloop_cli.case.scalars import plain_value

_NO_WRAP = 2**31
_TEXT = "tag:yaml.org,2002:str"
_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def dump(values: Mapping[str, Any]) -> str:
    """Plain values as YAML text that `read_document` reads back exactly."""
    return yaml.dump(
        dict(values),
        Dumper=_Dumper,
        sort_keys=False,
        default_flow_style=None,
        allow_unicode=True,
        width=_NO_WRAP,
    )


class _Dumper(yaml.SafeDumper):
    """Writes text so that it reads back as text by YAML 1.2 as well as 1.1, and never writes aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def _resolved_by_pyyaml(dumper: Any, value: str) -> str:
    tag: str = dumper.resolve(yaml.ScalarNode, value, (True, False))
    return tag


def _represent_text(dumper: yaml.SafeDumper, value: str) -> yaml.ScalarNode:
    is_plain = _WORD.fullmatch(value) and plain_value(value) == value
    is_plain_in_1_1 = _resolved_by_pyyaml(dumper, value) == _TEXT
    return dumper.represent_scalar(_TEXT, value, style=None if is_plain and is_plain_in_1_1 else '"')


def _represent_float(dumper: yaml.SafeDumper, value: float) -> yaml.ScalarNode:
    return dumper.represent_float(value + 0.0)  # -0.0 equals 0.0, so it must read the same


_Dumper.add_representer(str, _represent_text)
_Dumper.add_representer(float, _represent_float)
