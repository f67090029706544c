"""A terminal on a pseudo-terminal: keeps what programs write."""

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

from tests.support.program.pseudo_terminal import open_terminal

ROOT = Path(__file__).parents[3]


class Terminal:
    """Runs the command line with a terminal as its stdin, stdout and stderr."""

    def __init__(self, *arguments: str, seconds: float = 0.0) -> None:
        self.written = b""
        self._master, slave = open_terminal()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 640, 384))
        env = dict(os.environ)
        env |= {"TERM": "xterm-256color", "FAKE_SECONDS": str(seconds), "PYTHONPATH": str(ROOT)}
        self._slave = slave

        def leads_the_terminal() -> None:
            os.setsid()
            fcntl.ioctl(0, termios.TIOCSCTTY, 0)

        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.support.program.fake_session", *arguments],
            stdin=slave,
            stdout=slave,
            stderr=slave,
            env=env,
            preexec_fn=leads_the_terminal,
        )

    def read(self, until: bytes = b"", seconds: float = 30.0) -> bytes:
        """Reads until the bytes came, or the program ended."""
        end = time.monotonic() + seconds
        while time.monotonic() < end and not (until and until in self.written):
            if not select.select([self._master], [], [], 0.05)[0]:
                if self.process.poll() is not None:
                    break
                continue
            self.written += os.read(self._master, 65536)
        return self.written

    def types(self, text: bytes) -> None:
        """Types on its keyboard."""
        os.write(self._master, text)

    def lines(self) -> str:
        """Words that were written, without control sequences."""
        return re.sub(rb"\x1b(\[[?>]?[0-9;]*[a-zA-Z]|[78])", b"", self.written).decode()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        os.close(self._master)
        os.close(self._slave)
