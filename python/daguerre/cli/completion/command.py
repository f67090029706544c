"""``daguerre completion``: prints the script of a shell."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from daguerre.cli import console
from daguerre.errors import UsageError, suggest

SHELLS = ("bash", "zsh", "fish")
SCRIPTS = Path(__file__).parent / "scripts"


def completion(
    shell: Annotated[
        str | None, typer.Argument(metavar="|".join(SHELLS), help="Shell [from $SHELL].")
    ] = None,
) -> int:
    """Prints a script with which a shell completes commands, flags, names and files by TAB.

    Write it into the file where your shell looks for completions.
    """
    name = _of_user(shell)
    console.show((SCRIPTS / f"daguerre.{name}").read_text("utf-8").rstrip("\n"))
    return 0


def _of_user(shell: str | None) -> str:
    """The shell that was named, else the user's shell."""
    found = shell if shell is not None else Path(os.environ.get("SHELL", "")).name
    if found not in SHELLS:
        where = "completion" if shell is not None else "completion: $SHELL"
        got = repr(found) if found else "nothing"
        raise UsageError(f"{where}: wanted bash, zsh or fish, got {got}{suggest(found, SHELLS)}")
    return found
