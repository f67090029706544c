"""The fuzz of readers in Python: it finds nothing in 150 files, and it finds planted faults."""

from __future__ import annotations

import random
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from . import readers, uses


@pytest.mark.parametrize("name", readers.READERS)
def test_changed_files_are_used_or_refused(name: str) -> None:
    found, faults = readers.run(name, 120, seed=7, most=150)
    assert not faults
    assert found.tried == 150
    assert found.accepted > 0


PLANTED = {
    "an exception": ("raise KeyError('planted')", "KeyError: 'planted'"),
    "a crash": ("import os; os.kill(os.getpid(), 11)", ""),
    "memory": ("held = b'x' * 1_200_000_000", "MB"),
    "two lines": ("raise errors.InputError('one\\ntwo')", "not one line"),
    "time": ("readers.LIMIT_S = -1.0", "it took 0.0 s"),
}
PROGRAM = """
import sys
from daguerre import errors
from tests.fuzz import readers, uses

def use(path):
    {}

uses.recipe = use
sys.exit(readers.main())
"""


@pytest.mark.parametrize("fault", PLANTED)
def test_planted_faults_are_found(fault: str, monkeypatch: pytest.MonkeyPatch) -> None:
    code, said = PLANTED[fault]
    real = subprocess.run

    def run(words: list[str], **options: Any) -> Any:
        return real([words[0], "-c", PROGRAM.format(code), *words[3:]], **options)

    monkeypatch.setattr(readers.subprocess, "run", run)
    _, faults = readers.run("json", 60, most=2)
    assert len(faults) == 2
    assert said in faults[0]


def test_the_same_seed_changes_files_in_the_same_way() -> None:
    def digest() -> list[bytes]:
        return [
            readers.changed(random.Random(f"x {i}"), "a.json", b'{"a": [1, 2, {"b": "c"}]}')
            for i in range(200)
        ]

    assert digest() == digest()
    assert len(set(digest())) > 100


def test_the_command_says_what_it_tried(tmp_path: Path) -> None:
    words = ["--seconds", "3", "--keep", str(tmp_path), "calibration"]
    run = subprocess.run(
        [sys.executable, "-m", "tests.fuzz.readers", *words],
        cwd=readers.ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.startswith("fuzz: calibration: ")
    assert "0 faults" in run.stdout


def test_a_slow_file_is_kept_as_it_was_tried(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tried: list[bytes] = []
    monkeypatch.setattr(uses, "recipe", lambda path: tried.append(path.read_bytes()))
    monkeypatch.setattr(readers, "LIMIT_S", -1.0)
    with pytest.raises(RuntimeError, match="it took"):
        readers.work("json", 1, 1_000_000, 60, 1, tmp_path)
    (kept,) = tmp_path.glob("case-*")
    assert [kept.read_bytes()] == tried
