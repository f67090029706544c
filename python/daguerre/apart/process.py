"""Starts, watches and ends a helper process.

The limits are watched here, where a fault of the helper cannot touch them. The helper has a session
to itself, so Ctrl-C reaches this process alone. It has a folder for temporary files, made on first
use and removed with the helper. It holds the reading end of a pipe, and the kernel signals when
this process, at the writing end, is gone.
"""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from . import child
from .limits import Limits, ended, too_long, too_much
from .link import DamagedError, Link

#: Time between two looks at the memory of the helper, s.
_TICK = 0.02
#: Most time of waiting for a processor that does not count, for each second of the limit: threads
#: of the helper may compete with one another.
_PATIENCE = 2.0
#: Time for the start of a helper, s.
_START = Limits(60.0, 1 << 31)
#: Address space of a thread's stack, bytes, and threads besides those for each processor.
_STACK, _SPARE = 1 << 23, 8
#: Bytes of standard error that are kept.
_KEPT = 1 << 14
_PAGE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096


class EndedError(Exception):
    """The helper ended; the message says how."""


class Process:
    """A helper process.

    Raises:
        OSError: The process cannot be started.
    """

    def __init__(self) -> None:
        if not sys.executable or getattr(sys, "frozen", False):
            raise OSError("no Python to start")
        self._folder = str(Path(tempfile.gettempdir(), f"daguerre-{secrets.token_hex(8)}"))
        ours, theirs = socket.socketpair()
        life, self._life = os.pipe()
        self._words = bytearray()
        self._peak, self._ready = 0.0, False
        try:
            self._process = self._started(theirs.fileno(), life)
        except (OSError, ValueError):
            ours.close()
            os.close(self._life)
            raise
        finally:
            theirs.close()
            os.close(life)
        assert self._process.stderr is not None
        self._errors = self._process.stderr.fileno()
        os.set_blocking(self._errors, False)
        ours.setblocking(False)
        self._socket = ours
        self.link = Link(ours, self._wait)
        self.limit(_START)
        paths = [path for path in sys.path if Path(path).is_absolute()]
        with self.watched():
            self.link.send(b"p", [json.dumps(paths).encode()])

    def _started(self, end: int, life: int) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, "-I", child.__file__, str(end), str(life)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            pass_fds=(end, life),
            start_new_session=True,
            env={**os.environ, "TMPDIR": self._folder},
            cwd="/",
        )

    @property
    def pid(self) -> int:
        """Its number."""
        return self._process.pid

    @property
    def alive(self) -> bool:
        """Whether the process runs."""
        return self._process.poll() is None

    def limit(self, limits: Limits, *, anew: bool = True) -> None:
        """Sets its limits; ``anew``: the time begins now."""
        self.limits = limits
        if anew:
            self._peak = 0.0
            self._begin = self._looked = time.monotonic()
            self._waits = self._waited()
        self._bound_memory()

    @contextlib.contextmanager
    def watched(self) -> Iterator[None]:
        """Turns the end of the helper into ``EndedError``; any other error ends it, too."""
        try:
            yield
        except (EOFError, ConnectionError):
            self._drain()
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(1.0)
            code = self._process.poll()
            words = self._words.decode("utf-8", "replace")
            self.end()
            gone = "the helper process closed its connection"
            how = gone if code is None else ended(code, self._peak, self.limits, words)
            raise EndedError(how) from None
        except DamagedError as error:
            self.end()
            raise EndedError(f"the helper process sent {error}") from None
        except BaseException:
            self.end()
            raise

    def kill(self) -> None:
        """Ends it, with all that it started."""
        if self._process.returncode is None:
            with contextlib.suppress(OSError):
                os.killpg(self.pid, signal.SIGKILL)

    def end(self) -> None:
        """Ends it, with all that it started, and removes its temporary files."""
        self.kill()
        self._process.wait()
        self.forget()
        shutil.rmtree(self._folder, ignore_errors=True)

    def forget(self) -> None:
        """Closes this process's ends only, as after a fork."""
        if self._process.returncode is None:
            self._process.returncode = 0  # not ours to wait for
        if self._process.stderr is not None:
            self._process.stderr.close()
        self._socket.close()
        if self._life >= 0:
            os.close(self._life)
            self._life = -1

    def _wait(self, sends: bool) -> None:
        """Waits until the connection takes or has bytes; looks at the limits meanwhile."""
        wanted = select.POLLOUT if sends else select.POLLIN
        poll = select.poll()
        poll.register(self._socket, wanted)
        poll.register(self._errors, select.POLLIN)
        while True:
            found = dict(poll.poll(1000 * _TICK))
            events = found.pop(self._socket.fileno(), 0)
            if found:
                self._drain()
                if found[self._errors] & select.POLLHUP:
                    poll.unregister(self._errors)
            if time.monotonic() - self._looked > _TICK:
                self.judge()
            if events:
                return

    def judge(self) -> None:
        """Ends the helper if it is beyond its limits.

        Raises:
            EndedError: The helper exceeded a limit, and was ended.
        """
        self._looked = time.monotonic()
        self._peak = max(self._peak, self.resident)
        if self._peak > self.limits.memory:
            self.end()
            raise EndedError(too_much(self.limits))
        used, most = self._looked - self._begin, self.limits.seconds
        if used > most and used - min(self._waited() - self._waits, _PATIENCE * most) > most:
            self.end()
            raise EndedError(too_long(self.limits))

    def _drain(self) -> None:
        with contextlib.suppress(BlockingIOError):
            while piece := os.read(self._errors, 1 << 16):
                self._words = (self._words + piece)[-_KEPT:]

    @property
    def resident(self) -> float:
        """Resident memory, bytes; 0: unknown."""
        words = self._read("statm").split()
        return _PAGE * int(words[1]) if len(words) > 1 else 0.0

    def _waited(self) -> float:
        """Time for which it waited for a processor, s; 0: unknown. Source: sched-stats.rst."""
        words = self._read("schedstat").split()
        return 1e-9 * int(words[1]) if len(words) > 1 else 0.0

    def _read(self, name: str) -> str:
        try:
            return Path(f"/proc/{self.pid}/{name}").read_text()
        except OSError:
            return ""

    def _bound_memory(self) -> None:
        """Makes the kernel refuse memory far beyond the limit; it may grow between two checks."""
        with contextlib.suppress(ImportError, AttributeError, OSError, ValueError):
            import resource

            words = self._read("statm").split()
            spare = max(self.limits.memory - _PAGE * int(words[1]), 0)
            data = _PAGE * int(words[5]) + spare + _STACK * (_SPARE + (os.cpu_count() or 1))
            hard = resource.prlimit(self.pid, resource.RLIMIT_DATA)[1]
            resource.prlimit(self.pid, resource.RLIMIT_DATA, (data, hard))
