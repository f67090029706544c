"""Reads hostile files of all kinds in one process, for long, and watches what stays behind.

    python -m tests.faults.soak [--minutes 10] [--seed 1] [NAME...]

NAMEs are those of :mod:`tests.fuzz.readers`, which makes and uses the files. After a third of the
time the process must not grow: resident memory, open files, threads, temporary files. The exit code
is 1 if it does.
"""

from __future__ import annotations

import argparse
import contextlib
import ctypes
import gc
import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from random import Random
from statistics import median
from typing import Any

from daguerre.errors import DaguerreError
from tests.fuzz import readers, seeds, uses

#: Use of a file, and the file.
Case = tuple[Callable[[Path], Any], Path]
#: Growth of memory that is allowed, MB: tables of Python and pages that malloc keeps.
MOST_MB = 16.0
#: Files of each kind between two kinds.
_RUN = 20


@dataclass
class State:
    """State of a process: its memory, MB, and numbers of things."""

    memory: float
    files: int
    threads: int
    temporary: int

    @classmethod
    def now(cls, folder: Path) -> State:
        """Measures after what is unused was given back."""
        gc.collect()
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).malloc_trim(0)
        status = Path("/proc/self/status").read_text()
        return cls(
            float(status.split("VmRSS:")[1].split()[0]) / 1024,
            len(os.listdir("/proc/self/fd")),  # noqa: PTH208
            threading.active_count(),
            sum(len(names) + len(folders) for _, folders, names in os.walk(folder)),
        )


@dataclass
class Soak:
    """Counts of files, and states at even times."""

    tried: int
    accepted: int
    states: list[State]

    @property
    def faults(self) -> list[str]:
        """Growth between the second third of the time and the last."""
        third = max(len(self.states) // 3, 1)
        middle, last = self.states[third : 2 * third], self.states[2 * third :]
        found = []
        for name, most in (("memory", MOST_MB), ("files", 0), ("threads", 0), ("temporary", 0)):
            before, after = (median(getattr(one, name) for one in part) for part in (middle, last))
            if after > before + most:
                found.append(f"{name}: {before:g} became {after:g}")
        return found


def cases(
    names: list[str], folder: Path, seed: int
) -> Iterator[tuple[Callable[[Path], Any], Path]]:
    """Uses and changed files, kind after kind, without end."""
    goods = {name: list(getattr(seeds, readers.READERS[name].seeds)(folder)) for name in names}
    number = 0
    while True:
        for name in goods:
            use = getattr(uses, readers.READERS[name].use)
            for _ in range(_RUN):
                number += 1
                rng = Random(f"{name} {seed} {number}")
                file, data = rng.choice(goods[name])
                path = folder / f"case-{file}"
                path.write_bytes(readers.changed(rng, file, data))
                yield use, path
                path.unlink(missing_ok=True)


def soak(names: list[str], seconds: float, seed: int, *, every: float) -> Soak:
    """Uses files of these kinds.

    Args:
        names: Names of :data:`tests.fuzz.readers.READERS`.
        seconds: Time for it.
        seed: Chooses files and changes.
        every: Time between two states, s.
    """
    with tempfile.TemporaryDirectory(prefix="soak-") as root:
        files, temporary = Path(root, "files"), Path(root, "temporary")
        files.mkdir()
        temporary.mkdir()
        before, tempfile.tempdir = tempfile.tempdir, str(temporary)
        os.environ["TMPDIR"] = str(temporary)
        done = Soak(0, 0, [])
        goods = {name: list(getattr(seeds, readers.READERS[name].seeds)(files)) for name in names}
        end = time.monotonic() + seconds
        next_ = time.monotonic() + every
        try:
            for use, path in cases(goods, files, seed):
                done.tried += 1
                with contextlib.suppress(DaguerreError):
                    use(path)
                    done.accepted += 1
                if time.monotonic() > next_:
                    done.states.append(State.now(temporary))
                    next_ = time.monotonic() + every
                if time.monotonic() > end:
                    return done
        finally:
            tempfile.tempdir = before
            del os.environ["TMPDIR"]
    raise AssertionError("cases end")


def main() -> int:
    """Prints the counts, the first and the last state, and what grew."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    names = given.names or list(readers.READERS)
    done = soak(names, 60 * given.minutes, given.seed, every=given.minutes * 0.5)
    print(f"soak: {done.tried} files, {done.accepted} accepted; faults: {done.faults or 'none'}")
    for state in done.states[:: max(len(done.states) // 12, 1)]:
        print(f"  {state}")
    return bool(done.faults)


if __name__ == "__main__":
    sys.exit(main())
