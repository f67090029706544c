"""A terminal on a pseudo-terminal: answers as real ones do, and keeps what programs write."""

from __future__ import annotations

import fcntl
import os
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path
from typing import Self

from tests.support.pseudo_terminal import open_terminal

ROOT = Path(__file__).parents[2]
#: Answers to the graphics question, the name and the attributes, as these programs give them.
ANSWERS = {
    "kitty": b"\x1b_Gi=31;OK\x1b\\\x1bP>|kitty(0.42.0)\x1b\\\x1b[?62;c",
    "iterm": b"\x1bP>|iTerm2 3.5.10\x1b\\\x1b[?64;1;2;4;6;17;18;21;22c",
    "sixel": b"\x1bP>|XTerm(390)\x1b\\\x1b[?63;1;2;4;6;9;15;16;22c",
    "plain": b"\x1b[?6c",
    "silent": b"",
}


class Terminal:
    """Runs the command line with a terminal as its stdin, stdout and stderr."""

    def __init__(self, kind: str, *arguments: str, seconds: float = 0.0, **env: str) -> None:
        self.answer, self.written = ANSWERS[kind], b""
        self._master, slave = open_terminal()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 640, 384))
        kept = {k: v for k, v in os.environ.items() if k not in ("TMUX", "TERM_PROGRAM")}
        kept |= {"TERM": "xterm-256color", "FAKE_SECONDS": str(seconds), "PYTHONPATH": str(ROOT)}
        self.before = termios.tcgetattr(slave)
        self._slave = slave

        def leads_the_terminal() -> None:
            os.setsid()
            fcntl.ioctl(0, termios.TIOCSCTTY, 0)

        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.support.fake_session", *arguments],
            stdin=slave,
            stdout=slave,
            stderr=slave,
            env=kept | env,
            preexec_fn=leads_the_terminal,
        )

    def read(self, until: bytes = b"", seconds: float = 30.0) -> bytes:
        """Reads until the bytes came, or the program ended; answers the question meanwhile."""
        end, asked = time.monotonic() + seconds, b"\x1b[c" in self.written
        while time.monotonic() < end and not (until and until in self.written):
            if not select.select([self._master], [], [], 0.05)[0]:
                if self.process.poll() is not None:
                    break
                continue
            self.written += os.read(self._master, 65536)
            if not asked and b"\x1b[c" in self.written:
                asked = True
                os.write(self._master, self.answer)
        return self.written

    def types(self, text: bytes) -> None:
        """Types on its keyboard."""
        os.write(self._master, text)

    def lines(self) -> str:
        """Words that were written, without pictures and control sequences."""
        pictures = re.compile(rb"\x1b[_P\]].*?(\x1b\\|\x07)", re.DOTALL)
        plain = re.sub(rb"\x1b(\[[?>]?[0-9;]*[a-zA-Z]|[78])", b"", pictures.sub(b"", self.written))
        return plain.decode()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        os.close(self._master)
        os.close(self._slave)
