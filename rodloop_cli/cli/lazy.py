"""A click group that knows its commands by name and imports one when it is called."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from typing import Any, NamedTuple

import click
from click.shell_completion import CompletionItem

from rodloop_cli.cli.settings import Settings, common_options
from rodloop_cli.errors import Interrupted, RodloopError


class Entry(NamedTuple):
    """One command: ``package.module:attribute`` and its line in the help."""

    target: str
    help: str


class ReaderGone(RodloopError):
    """Whoever read our output has stopped, as ``head`` does."""

    exit_code = 141  # 128 + SIGPIPE: what a shell reports for programs that the signal ends


class LazyGroup(click.Group):
    """Lists commands from a table, without importing them, for help and shell completion alike."""

    def __init__(self, *args: Any, table: Mapping[str, Entry], **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.table = table
        self.params += common_options()

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.table)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in self.table:
            return None
        command = _imported(cmd_name, self.table[cmd_name])
        present = {name for parameter in command.params for name in parameter.opts}
        command.params += [option for option in common_options() if present.isdisjoint(option.opts)]
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(name, entry.help) for name, entry in self.table.items()])

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        names = [name for name in self.table if name.startswith(incomplete)]
        options = click.Command.shell_complete(self, ctx, incomplete)
        return [CompletionItem(name, help=self.table[name].help) for name in names] + options

    def make_context(self, *args: Any, **kwargs: Any) -> click.Context:
        with _plain_endings():
            return super().make_context(*args, **kwargs)

    def invoke(self, ctx: click.Context) -> Any:
        ctx.ensure_object(Settings)
        with _plain_endings():
            return super().invoke(ctx)


def _imported(name: str, entry: Entry) -> click.Command:
    module, _, attribute = entry.target.partition(":")
    try:
        command: click.Command = getattr(import_module(module), attribute)
    except ModuleNotFoundError as error:
        if error.name != module:
            raise
        raise click.UsageError(f"'{name}' is not part of this installation of rodloop.") from None
    return command


@contextmanager
def _plain_endings() -> Iterator[None]:
    """Names Ctrl-C and a closed pipe before click handles them: with a blank line, and with exit code 1."""
    try:
        yield
    except KeyboardInterrupt:
        raise Interrupted("interrupted") from None
    except BrokenPipeError:
        raise ReaderGone from None
