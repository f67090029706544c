"""Hands cases to a worker and says what came of each; a dead worker is one failed case."""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from typing import Any

from .calls import ROOT, Outcome

#: Seconds by the clock after which a case that takes no CPU time counts as hung.
PATIENCE = 120.0
Case = tuple[str, int]


class Worker:
    """A process that runs cases one after the other."""

    def __init__(self) -> None:
        ours, theirs = os.pipe()
        self.errors = tempfile.TemporaryFile()  # noqa: SIM115 - closed with the worker
        self.process = subprocess.Popen(
            [sys.executable, "-X", "faulthandler", "-m", "tests.abuse.worker", str(theirs)],
            stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=self.errors, cwd=ROOT,
            text=True, pass_fds=[theirs],
        )  # fmt: skip
        os.close(theirs)
        self.pipe = os.fdopen(ours, "rb", buffering=0)

    def run(self, case: Case) -> Outcome:
        """The outcome of a case."""
        assert self.process.stdin is not None
        self.process.stdin.write(f"{case[0]} {case[1]}\n")
        self.process.stdin.flush()
        call = f"{case[0]} {case[1]}"
        while said := self._said():  # the last that was said
            if "kind" in said:
                return Outcome(said["call"], said["kind"], said["where"])
            call = said["begins"]
        return Outcome(call, self._end(), self._words())

    @property
    def alive(self) -> bool:
        return self.process.poll() is None

    def _said(self) -> Any:
        """A line of the pipe; None: the worker is gone, or gave no sign."""
        line = b""
        while not line.endswith(b"\n"):
            part = self.pipe.read(1 << 16) if self._speaks() else b""
            if not part:
                return None
            line += part
        return json.loads(line.splitlines()[-1])

    def _speaks(self) -> bool:
        return bool(select.select([self.pipe], [], [], PATIENCE)[0])

    def _end(self) -> str:
        """How the worker ended, in words."""
        try:
            code = self.process.wait(2)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return "hang"
        if code == -signal.SIGPROF:
            return "hang"
        return f"crash: {signal.Signals(-code).name}" if code < 0 else f"exit: {code}"

    def _words(self) -> str:
        self.errors.seek(0)
        return self.errors.read()[-800:].decode(errors="replace")

    def close(self) -> None:
        """Ends the process."""
        assert self.process.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        self.process.wait()
        self.pipe.close()
        self.errors.close()


def outcomes(cases: Iterable[Case]) -> Iterator[tuple[Case, Outcome]]:
    """The outcome of each case, in order; a new worker follows a dead one."""
    worker = Worker()
    try:
        for case in cases:
            if not worker.alive:
                worker.close()
                worker = Worker()
            yield case, worker.run(case)
    finally:
        worker.close()
