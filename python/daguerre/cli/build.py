"""The program as Typer sees it; commands are loaded when they are added."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import typer

from . import console
from .commands import COMMANDS, GROUPS
from .help import HELP_FLAGS, HelpCommand, HelpGroup


def program(*names: str) -> typer.Typer:
    """The program with some of its commands; default: all."""
    app = _empty()
    for name in names or COMMANDS:
        command = app.command(name=name, cls=HelpCommand, short_help=COMMANDS[name].line)
        command(_function(name))
    return app


def outline() -> typer.Typer:
    """The program for its help and for wrong commands: names and lines, with nothing loaded."""
    app = _empty()
    for heading, group in GROUPS.items():
        for name, command in group.items():
            add = app.command(name=name, short_help=command.line, rich_help_panel=heading)
            add(lambda: None)
    return app


def _empty() -> typer.Typer:
    app = typer.Typer(
        name="daguerre",
        cls=HelpGroup,
        help="Renders what a real camera would have recorded.",
        add_completion=False,
        no_args_is_help=False,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,  # its tables cut long flags off on a narrow terminal
        context_settings={"help_option_names": [*HELP_FLAGS]},
    )
    app.callback(invoke_without_command=True)(_top)
    return app


def _function(name: str) -> Any:
    """The function of a command, named like it with underscores."""
    return getattr(import_module(COMMANDS[name].module, __package__), name.replace("-", "_"))


def _top(
    context: typer.Context,
    version: bool = typer.Option(False, "--version", help="Print the version."),
) -> int | None:
    if version:
        from daguerre import __version__

        console.show(f"daguerre {__version__}")
        raise typer.Exit(0)
    if context.invoked_subcommand is None:
        console.show(context.get_help())
        raise typer.Exit(2)
    return None
