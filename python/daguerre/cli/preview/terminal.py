"""Detection of picture support in a terminal: by a query, or by environment variables.

Supported protocols: Kitty's graphics, iTerm2's inline images, and Sixel (DEC 1990).
"""

from __future__ import annotations

import os
import re
import select
import termios
import time
import tty
from collections.abc import Mapping
from enum import Enum
from typing import TextIO


class Way(Enum):
    """A picture protocol."""

    KITTY = "kitty"
    ITERM = "iterm"
    SIXEL = "sixel"


#: Query: for Kitty, a picture of one pixel that is not shown; then the terminal's name (XTVERSION);
#: then its attributes (DA1), which every terminal answers, so the answer always ends.
QUESTION = b"\x1b_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\" + b"\x1b[>q" + b"\x1b[c"
ATTRIBUTES = re.compile(rb"\x1b\[\?([0-9;]*)c")
#: Longest wait for an answer, s: remote terminals need some time.
PATIENCE_S = 0.4
#: Terminals that would print the query, and multiplexers, which do not pass pictures on.
DEAF = ("dumb", "linux", "screen", "tmux")


def way_of(stdin: TextIO, out: TextIO, environment: Mapping[str, str]) -> Way | None:
    """Protocol of the terminal ``out``; None: not a terminal, or without pictures."""
    name = environment.get("TERM", "")
    if not out.isatty() or not name or name.startswith(DEAF) or "TMUX" in environment:
        return None
    answer = b""
    if stdin.isatty() and _in_foreground(stdin.fileno()):
        answer = ask(stdin.fileno(), out.fileno())
    return read_answer(answer) if ATTRIBUTES.search(answer) else guess(environment)


def ask(given: int, out: int) -> bytes:
    """Queries the terminal; returns its answer, as far as it comes in time.

    Args:
        given: File descriptor of the answer.
        out: File descriptor of the query.
    """
    before = termios.tcgetattr(given)
    answer, until = b"", time.monotonic() + PATIENCE_S
    try:
        tty.setcbreak(given, termios.TCSANOW)  # no echo of the answer
        os.write(out, QUESTION)
        while (left := until - time.monotonic()) > 0 and not ATTRIBUTES.search(answer):
            if select.select([given], [], [], left)[0]:
                part = os.read(given, 1024)
                if not part:
                    break
                answer += part
    finally:
        # Discards late answers, so that they are not typed into the shell.
        termios.tcsetattr(given, termios.TCSAFLUSH, before)
    return answer


def read_answer(answer: bytes) -> Way | None:
    """Best protocol that an answer names."""
    if b"\x1b_Gi=31;OK" in answer:
        return Way.KITTY
    if b"P>|iTerm2" in answer:
        return Way.ITERM
    found = ATTRIBUTES.search(answer)
    return Way.SIXEL if found and b"4" in found[1].split(b";")[1:] else None


def guess(environment: Mapping[str, str]) -> Way | None:
    """Guesses the protocol from environment variables, for terminals that cannot be queried."""
    program = environment.get("TERM_PROGRAM", "") or environment.get("LC_TERMINAL", "")
    if "KITTY_WINDOW_ID" in environment or program == "ghostty":
        return Way.KITTY
    return Way.ITERM if program in ("iTerm.app", "iTerm2") else None


def _in_foreground(descriptor: int) -> bool:
    """Whether this process may read from its terminal; in the background it would be stopped."""
    try:
        return os.tcgetpgrp(descriptor) == os.getpgrp()
    except OSError:
        return False
