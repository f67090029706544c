"""Runs cases in a process of its own: a crash, a hang or a flood of memory ends it, not the tests.

The parent writes ``PATH NUMBER`` lines to its input; for each the worker writes to the pipe that
it was given what it begins, then what came of it, as JSON.
"""

from __future__ import annotations

import json
import os
import resource
import signal
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .calls import Outcome, run
from .world import World

#: CPU seconds of one case over all threads, and bytes of address space above those at the start.
SECONDS = float(os.environ.get("DG_ABUSE_SECONDS", "20"))
MOST_MB = 1000
_ROOM = 6 << 30


def main() -> None:
    """Until the input ends."""
    pipe = os.fdopen(int(sys.argv[1]), "w", buffering=1)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        world = World(Path(folder))
        used = _status("VmData") * 1024
        resource.setrlimit(resource.RLIMIT_DATA, (used + _ROOM, used + _ROOM))
        for line in sys.stdin:
            path, _, number = line.strip().rpartition(" ")
            _case(path, int(number), world, pipe)


def _case(path: str, number: int, world: World, pipe: Any) -> None:
    def tell(**said: Any) -> None:
        pipe.write(json.dumps(said) + "\n")

    before = 0

    def began(call: str) -> None:
        nonlocal before
        tell(begins=call)
        Path("/proc/self/clear_refs").write_text("5")  # the peak of memory starts anew
        before = _status("VmRSS")

    try:
        with _time():
            outcome = run(path, number, world, began)
    except MemoryError as error:  # while arguments were made
        outcome = Outcome(path, "MemoryError", f"of the test's own: {error}")
    grown = (_status("VmHWM") - before) // 1024
    if grown > MOST_MB:
        outcome = Outcome(outcome.call, "memory", f"{grown} MB; {outcome.kind}: {outcome.where}")
    tell(kind=outcome.kind, call=outcome.call, where=outcome.where)


@contextmanager
def _time() -> Iterator[None]:
    """Ends the process when a case has had its time: no handler, so nothing can catch it."""
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def _status(name: str) -> int:
    """A line of this process's status, kB."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith(name)).split()[1])


if __name__ == "__main__":
    main()
