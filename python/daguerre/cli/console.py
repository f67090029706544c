"""Messages of the command line: notes, warnings and errors on stderr, one line each."""

from __future__ import annotations

import errno
import os
import shlex
import sys
from collections.abc import Callable
from io import TextIOWrapper
from pathlib import Path
from typing import TextIO

#: the arguments that this run was started with, without the program's name
argv: list[str] = []

#: function that prints messages, so that a progress bar can make room for them
writer: Callable[[str], None] | None = None
quiet = False


def plain(text: str) -> str:
    r"""Escapes control characters, and those that cannot be encoded, such as ``\x1b``.

    File names and texts in pictures are untrusted: escape sequences in them could clear the screen,
    retitle the window, or type. Newlines stay.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c == "\n" else _escaped(c) for c in text)


def _escaped(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")


def show(text: object = "") -> None:
    """Prints results on stdout."""
    print(plain(str(text)))


def say(text: str) -> None:
    """Prints a line on stderr, also with ``--quiet``."""
    line = plain(" ".join(text.split()))
    try:
        if writer is not None:
            writer(line)
        else:
            print(line, file=sys.stderr, flush=True)
    except OSError:  # the reader or the terminal has gone, or the disk of a log is full
        nobody_reads(sys.stderr)


def nobody_reads(stream: TextIO) -> None:
    """Discards further output of a stream after its reader has gone; the render goes on."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)


def open_streams() -> None:
    r"""Opens streams that were closed before the start, on the null device.

    Otherwise the next file to be opened would get the number of a stream, and messages would go
    into that file. Letters that the encoding of a stream lacks become ``\xe9`` and the like: a name
    with an accent must not end a command on a terminal that has ASCII alone.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            mode = "r" if number == 0 else "w"
            setattr(sys, name, Path(os.devnull).open(mode))  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper) and stream.errors in ("strict", "surrogateescape"):
            stream.reconfigure(errors="backslashreplace")


def is_stuck(error: OSError) -> bool:
    """Whether the error is of a stream; errors of files have a file name."""
    stuck = errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO
    return error.filename is None and error.errno in stuck


def note(text: str) -> None:
    """Prints a note."""
    if not quiet:
        say(f"daguerre: {text}")


def warn(text: str) -> None:
    """Prints a warning: about a result that the user probably does not want."""
    if not quiet:
        say(f"daguerre: warning: {text}")


def error(text: str) -> None:
    """Prints the error that ends the command."""
    say(f"daguerre: error: {text}")


def command_line(*extra: str) -> str:
    """Command line of this run, to be typed again, with further flags if they are missing."""
    words = ["daguerre", *argv, *(flag for flag in extra if flag not in argv)]
    return shlex.join(words)
