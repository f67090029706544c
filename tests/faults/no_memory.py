"""Memory that ends in the middle of a command: each allocation fails in turn, of C and C++ alike.

Run as ``python -m tests.faults.no_memory LEAST MOST WORD...`` with ``failing_malloc.c`` preloaded:
runs a command in children of its own, in each of which another allocation of at least LEAST bytes
fails, MOST of them at the most, spread evenly. Prints how the command ended, as JSON. Failures
begin with the command itself, after its line is read.
"""

from __future__ import annotations

import ctypes
import functools
import hashlib
import json
import os
import pkgutil
import signal
import sys
import tempfile
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path

import numpy as np

import daguerre
from daguerre import cli

_NEVER = 1 << 62


@dataclass(frozen=True)
class End:
    """How a command ended.

    Attributes:
        at: The allocation that failed.
        code: The exit code, or minus the signal.
        said: Its lines.
        files: Hashes of the files that it left, by name.
        resumed: The same after ``--resume``, where it left a checkpoint.
        counted: Allocations.
    """

    at: int
    code: int
    said: list[str]
    files: dict[str, str]
    resumed: dict[str, str] | None
    counted: int


def run(words: list[str], at: int, least: int) -> End:
    """Runs a command in a child whose allocation fails, and resumes it in one whose does not."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        code, said, counted = _child(folder, words, at, least)
        files, resumed = _files(folder), None
        if any("checkpoint" in name for name in files):
            _child(folder, [*words, "--resume"], _NEVER, least)
            resumed = _files(folder)
        return End(at, code, said, files, resumed, counted)


def _child(folder: Path, words: list[str], at: int, least: int) -> tuple[int, list[str], int]:
    """Exit code, lines and number of allocations of a command."""
    said, counted = folder / "said", folder / "counted"
    child = os.fork()
    if child == 0:
        os.chdir(folder)
        stream = os.open(said, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
        os.dup2(stream, 1)
        os.dup2(stream, 2)
        signal.alarm(120)
        memory = ctypes.CDLL(None)
        _arm(words[0], functools.partial(memory.fail_at, ctypes.c_long(at), least))
        code = cli.main(words)
        found = memory.counted()
        memory.fail_at(ctypes.c_long(-1), 0)
        counted.write_text(str(found))
        os._exit(code)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    lines = [line for line in said.read_text(errors="replace").splitlines() if line]
    number = int(counted.read_text()) if counted.exists() else 0
    said.unlink()
    counted.unlink(missing_ok=True)
    return code, lines, number


def _files(folder: Path) -> dict[str, str]:
    return {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.iterdir())
    }


def _arm(command: str, arm: functools.partial[None]) -> None:
    """Lets the command begin by setting the failure."""
    module = import_module(cli.COMMANDS[command].module, cli.__name__)
    inner = getattr(module, command)

    @functools.wraps(inner)
    def armed(*args: object, **keywords: object) -> object:
        arm()
        return inner(*args, **keywords)

    setattr(module, command, armed)


def main(least: int, most: int, words: list[str]) -> None:
    """Prints the end of the whole command, then those of the failures."""
    for module in pkgutil.walk_packages(daguerre.__path__, "daguerre."):
        if not module.name.endswith("__main__"):
            import_module(module.name)
    for name in ("OpenEXR", "OpenImageIO", "numpy.ma"):
        import_module(name)
    whole = run(words, _NEVER, least)
    places = np.unique(np.linspace(0, whole.counted - 1, most).astype(int))
    ends = [whole, *(run(words, int(at), least) for at in places)]
    print(json.dumps([asdict(end) for end in ends]))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3:])
