"""Reads and draws mutants of stages under strace, and lists what they opened outside their folder.

    python -m tests.faults.traced_stages [--count 5000] [--seed 1] [--keep FOLDER]

All mutants are read by one process, which must not end; none may take more than 10 s of CPU time,
plus what the helper waits for a processor. Opens of libraries, Python's files, packages, fonts,
/proc and /sys do not count (``system_folders`` of ``tests/project/test_syscalls.py``). The exit
code is 1 after any fault.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from daguerre import _core
from daguerre.errors import DaguerreError
from tests.fuzz import uses
from tests.project.test_syscalls import OURS, system_folders

from . import stage_mutants

ROOT = Path(__file__).resolve().parents[2]
_CALLS = "open,openat,openat2,creat,execve,connect"
#: A call that succeeded: its name, its arguments, and its result, with the file that was opened.
_CALL = re.compile(r"^(?P<name>\w+)\((?P<arguments>.*)\)\s+=\s+(?P<result>\d+)(<(?P<path>[^>]*)>)?")
#: Most time for a mutant, s: the limits of a helper, with its patience, and the picture.
_MOST = 45.0


@dataclass
class Run:
    """Result of a run.

    Attributes:
        tried: Number of mutants.
        ends: How they ended: read, refused, or how the helper ended.
        slowest: Most time for a mutant, s.
        faults: Sentences on what went wrong.
    """

    tried: int = 0
    ends: Counter[str] = field(default_factory=Counter)
    slowest: float = 0.0
    faults: list[str] = field(default_factory=list)


def work(inside: Path, seed: int, count: int) -> None:
    """Reads mutants; a line of JSON tells how each ended."""
    goods = stage_mutants.seeds(inside)
    for name, data in stage_mutants.mutants(goods, seed, count):
        path = inside / f"case-{name}"
        path.write_bytes(data)
        begin = time.monotonic()
        try:
            uses.drawn(path)
            end = "read"
        except DaguerreError as error:
            found = re.search(r"the helper process (ended by \w+|took (longer|more))", str(error))
            end = found[1] if found else "refused" if "\n" not in str(error) else "two lines"
        print(json.dumps({"end": end, "s": time.monotonic() - begin}), flush=True)
    print(json.dumps("done"), flush=True)


def traced(folder: Path, seed: int, count: int) -> Run:
    """Reads mutants in a process under strace.

    Args:
        folder: Folder for all files; it is the only one that may be opened.
        seed: Seed of the mutants.
        count: Number of mutants.
    """
    inside, log, found = stage_mutants.write_folder(folder / "work"), folder / "log", Run()
    for name in ("log", "tmp", "home"):
        (folder / name).mkdir()
    strace = shutil.which("strace")
    assert strace is not None
    command = [
        strace,
        "-ff",
        "--seccomp-bpf",
        "-f",
        "-y",
        "-qq",
        "-s",
        "400",
        "-o",
        str(log / "of"),
    ]
    command += ["-e", f"trace={_CALLS}", sys.executable, "-m", "tests.faults.traced_stages"]
    environment = {
        **os.environ,
        "TMPDIR": str(folder / "tmp"),
        "HOME": str(folder / "home"),
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
    }
    words = [*command, "--work", str(inside), "--seed", str(seed), "--count", str(count)]
    with (folder / "said").open("wb") as said, (folder / "errors").open("wb") as errors:
        done = subprocess.run(
            words, env=environment, cwd=ROOT, stdout=said, stderr=errors, check=False
        )
    lines = [json.loads(line) for line in (folder / "said").read_text().splitlines()]
    if done.returncode or not lines or lines[-1] != "done":
        wrong = (folder / "errors").read_text(errors="replace")[-600:]
        found.faults.append(f"the process ended: {done.returncode}: {len(lines)} lines: {wrong}")
    for line in (one for one in lines if one != "done"):
        found.tried += 1
        found.ends[line["end"]] += 1
        found.slowest = max(found.slowest, line["s"])
        if line["s"] > _MOST or line["end"] == "two lines":
            found.faults.append(f"mutant {found.tried - 1}: {line}")
    own = [str(one.resolve()) for one in (inside, log, folder / "tmp", folder / "home")]
    own += [str(ROOT / "tests"), str(Path(_core.__file__).resolve().parent)]  # this program
    own += [os.path.realpath(one) for one in sys.path if one and Path(one) != ROOT]
    found.faults += outside(log, own)
    return found


def outside(log: Path, own: list[str]) -> list[str]:
    """Calls in the files of a trace that lead elsewhere: opens, programs, connections."""
    allowed, found, programs = [*system_folders(), *own], set[str](), 0
    for file in log.iterdir():
        for line in file.read_text(errors="replace").splitlines():
            call = _CALL.match(line)
            if call is None:
                continue
            if call["name"] == "execve":
                programs += 1
                ours = any(f"daguerre/{one}" in call["arguments"] for one in OURS)
                if not ours and "tests.faults.traced_stages" not in call["arguments"]:
                    found.add(line)
            elif call["name"] == "connect":
                found.add(line)
            else:
                path = call["path"] or "?"
                known = any(path == one or path.startswith(f"{one}/") for one in allowed)
                if path != str(ROOT) and not known:
                    found.add(line)
    return sorted(found) if programs else ["strace saw no program"]


def main() -> int:
    """Runs the mutants; see the head of the file."""
    parser = argparse.ArgumentParser(description=__doc__, add_help=True)
    parser.add_argument("--count", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, help="folder for the files, which stay")
    parser.add_argument("--work", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.work is not None:
        work(given.work, given.seed, given.count)
        return 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.keep or Path(temporary)
        begin = time.monotonic()
        found = traced(folder, given.seed, given.count)
        ends = ", ".join(f"{count} {end}" for end, count in found.ends.most_common())
        took = time.monotonic() - begin
        print(f"{found.tried} mutants in {took:.0f} s: {ends}; slowest {found.slowest:.1f} s")
        for fault in found.faults[:50]:
            print(fault)
    return 1 if found.faults else 0


if __name__ == "__main__":
    sys.exit(main())
