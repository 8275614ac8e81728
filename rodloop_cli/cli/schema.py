"""``rodloop schema``: the case file for machines."""

from __future__ import annotations

import json

import click

DIALECT = "https://json-schema.org/draft/2020-12/schema"


@click.command()
def schema() -> None:
    """Print the JSON Schema of case files.

    Editors that know YAML complete and check case files with it, for instance after the line
    '# yaml-language-server: $schema=case.schema.json'.
    """
    from rodloop_cli.case import Case

    click.echo(json.dumps({"$schema": DIALECT, **Case.model_json_schema()}, indent=2, ensure_ascii=False))
