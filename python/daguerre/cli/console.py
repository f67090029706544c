"""Messages of the command line: notes, warnings and errors on stderr, one line each."""

from __future__ import annotations

import errno
import os
import shlex
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TextIO

#: the arguments that this run was started with, without the program's name
argv: list[str] = []

#: what is said goes through here, so that a progress bar can make room for it
writer: Callable[[str], None] | None = None
quiet = False


def plain(text: str) -> str:
    r"""The text with what a terminal would obey, or that cannot be encoded, written as ``\x1b``.

    Names of files and words of pictures come from strangers: escape sequences in them could clear
    the screen, retitle the window, or type. Lines stay lines.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c == "\n" else _escaped(c) for c in text)


def _escaped(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")


def show(text: object = "") -> None:
    """Lines on stdout: what was asked for."""
    print(plain(str(text)))


def say(text: str) -> None:
    """A line on stderr, whatever ``--quiet`` says."""
    line = plain(" ".join(text.split()))
    try:
        if writer is not None:
            writer(line)
        else:
            print(line, file=sys.stderr, flush=True)
    except OSError:  # the reader or the terminal has gone, or the disk of a log is full
        nobody_reads(sys.stderr)


def nobody_reads(stream: TextIO) -> None:
    """Whoever read this stream has gone; the picture is still wanted, words about it are not."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)


def open_streams() -> None:
    """Gives streams that were closed before the start somewhere to go.

    Else the next file that is opened has the number of one of them, and words go into it.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            mode = "r" if number == 0 else "w"
            setattr(sys, name, Path(os.devnull).open(mode))  # noqa: SIM115


def is_stuck(error: OSError) -> bool:
    """Whether a stream could not be written: an error of a file has its name."""
    stuck = errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO
    return error.filename is None and error.errno in stuck


def note(text: str) -> None:
    """Something good to know."""
    if not quiet:
        say(f"daguerre: {text}")


def warn(text: str) -> None:
    """Something that is probably not wanted."""
    if not quiet:
        say(f"daguerre: warning: {text}")


def error(text: str) -> None:
    """Why nothing more is done."""
    say(f"daguerre: error: {text}")


def command_line(*extra: str) -> str:
    """This run's command, to be typed again, with flags added unless they are there."""
    words = ["daguerre", *argv, *(flag for flag in extra if flag not in argv)]
    return shlex.join(words)
