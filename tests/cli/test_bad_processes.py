"""The catalogue of bad files, each met by a process: time, memory, exit code, remains."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.bad_files import CASES, Case
from tests.cli.test_bad_files import check_lines, check_picture, contents

pytestmark = pytest.mark.slow

#: On a quiet machine 10 s of wall time; CPU time does not depend on who else is there.
CPU_S, WALL_S, MEMORY_BYTES = 10.0, 60.0, 1 << 30


@dataclass(frozen=True)
class Ended:
    """How a process ended."""

    code: int
    text: str
    cpu_s: float
    peak_bytes: int


def run(words: list[str], temporary: Path) -> Ended:
    """Runs ``daguerre`` with these words; its temporary files go into a folder of its own."""
    environment = {**os.environ, "TMPDIR": str(temporary), "DAGUERRE_DEBUG": ""}
    with tempfile.TemporaryFile() as heard:
        process = subprocess.Popen(
            [sys.executable, "-m", "daguerre.cli", *words],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=heard,
            env=environment,
        )
        deadline = time.monotonic() + WALL_S
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > deadline:
                process.kill()
                deadline += WALL_S
            time.sleep(0.02)
        process.returncode = os.waitstatus_to_exitcode(status)
        heard.seek(0)
        text = heard.read().decode(errors="replace")
    cpu = usage.ru_utime + usage.ru_stime
    return Ended(process.returncode, text, cpu, usage.ru_maxrss * 1024)


def check_case(case: Case, folder: Path) -> str:
    """Says how the process ended wrongly; empty if it did not."""
    try:
        inputs, outputs, temporary = (folder / name for name in ("in", "out", "tmp"))
        for path in (inputs, outputs, temporary):
            path.mkdir(parents=True)
        bad = case.make(inputs)
        before = contents(inputs)
        ended = run(case.words(bad, outputs / "o"), temporary)
        check_lines(case, bad, ended.code, ended.text)
        assert ended.cpu_s <= CPU_S, f"{ended.cpu_s:.1f} s"
        assert ended.peak_bytes <= MEMORY_BYTES, f"{ended.peak_bytes >> 20} MiB"
        assert contents(temporary) == set(), "temporary files were left"
        if case.error:
            assert contents(outputs) == set(), "an output was left"
            assert contents(inputs) == before, "something was left beside the file"
        elif (outputs / "o.exr").exists():
            check_picture(case, outputs / "o.exr")
    except AssertionError as error:
        return f"{case.name}: {error}"
    return ""


def test_each_bad_file_in_a_process(tmp_path: Path) -> None:
    with ThreadPoolExecutor(2) as two:
        folders = [tmp_path / f"{i}" for i in range(len(CASES))]
        wrong = [text for text in two.map(check_case, CASES, folders) if text]
    assert not wrong, "\n".join([f"{len(wrong)} of {len(CASES)}:", *wrong])


def test_info_of_bad_scenes(tmp_path: Path) -> None:
    """``info`` reads the same files: an error, or a table; one scene in eight."""

    def check(case: Case, folder: Path) -> str:
        folder.mkdir()
        bad = case.make(folder)
        ended = run(["info", str(bad)], folder)
        fine = ended.code in ((0, 3) if case.error else (0,)) and "Traceback" not in ended.text
        return "" if fine and ended.cpu_s <= CPU_S else f"{case.name}: {ended}"

    chosen = [case for case in CASES if case.command[1] == "{bad}" and case.command[0] == "render"]
    with ThreadPoolExecutor(2) as two:
        folders = [tmp_path / f"{i}" for i in range(len(chosen))]
        wrong = [text for text in two.map(check, chosen[::8], folders) if text]
    assert not wrong, "\n".join(wrong)
