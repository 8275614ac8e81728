"""What the options that every command has (-v, -q, --debug) decide."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import click

_LEVELS = {-1: logging.ERROR, 0: logging.WARNING, 1: logging.INFO}


@dataclass
class Settings:
    """Filled in while the command line is read, before a command runs."""

    verbosity: int = 0
    debug: bool = False

    @property
    def quiet(self) -> bool:
        """No progress bar and no summary are wanted."""
        return self.verbosity < 0

    def log_to_stderr(self) -> None:
        """Show the package's log messages from the level that the verbosity stands for."""
        logger = logging.getLogger("rodloop_cli")
        logger.setLevel(_LEVELS.get(max(self.verbosity, -1), logging.DEBUG))
        logger.handlers = [logging.StreamHandler()]


def current_settings() -> Settings:
    """The settings of the command that is running (the defaults outside of any)."""
    context = click.get_current_context(silent=True)
    return (context and context.find_object(Settings)) or Settings()


def _count(names: list[str], step: int, words: str) -> click.Option:
    def callback(context: click.Context, _: click.Parameter, times: int) -> None:
        settings = context.ensure_object(Settings)
        settings.verbosity += step * times
        settings.log_to_stderr()

    return click.Option(names, count=True, expose_value=False, callback=callback, help=words)


def _debug() -> click.Option:
    def callback(context: click.Context, _: click.Parameter, wanted: bool) -> None:
        context.ensure_object(Settings).debug |= wanted

    words = "Show the traceback of an internal error."
    return click.Option(["--debug"], is_flag=True, expose_value=False, callback=callback, help=words)


def common_options() -> list[click.Parameter]:
    """Options that may stand before or after the name of the command."""
    more = _count(["-v", "--verbose"], +1, "Say more; twice for still more.")
    less = _count(["-q", "--quiet"], -1, "Say less.")
    return [more, less, _debug()]
