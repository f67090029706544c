"""``daguerre completion``: the script of a shell, installed, removed or printed."""

from __future__ import annotations

from typing import Annotated

import typer

from daguerre.cli import console
from daguerre.cli.flags.groups import option
from daguerre.errors import UsageError

from .installing import SHELLS, install, of_user, remove, script


def completion(
    shell: Annotated[
        str | None, typer.Argument(metavar="|".join(SHELLS), help="Shell [from $SHELL].")
    ] = None,
    install_it: Annotated[
        bool, option("--install", help="Install the script for you, not for other users.")
    ] = False,
    remove_it: Annotated[
        bool, option("--remove", help="Remove it, and leave everything as it was.")
    ] = False,
) -> int:
    """Prints a script with which a shell completes commands, flags, names and files by TAB.

    --install puts it where your shell finds it; --remove takes it away again.
    """
    if install_it and remove_it:
        raise UsageError("--install and --remove: wanted one of them, got both")
    shell = of_user(shell)
    if install_it:
        for text in install(shell):
            console.note(text)
        console.note(f"open a new {shell} to use it")
    elif remove_it:
        for text in remove(shell) or [f"no completion of {shell} is installed"]:
            console.note(text)
    else:
        console.show(script(shell).rstrip("\n"))
    return 0
