"""Kills at random instants: few of them in every run, 300 with the slow tests."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def kills(*words: str) -> str:
    """Runs them in a process that has drawn nothing, since its forks must draw; the table."""
    run = subprocess.run(
        [sys.executable, "-m", "tests.faults.kills", *words],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout


def test_a_few_kills() -> None:
    assert "plain: 6 kills" in kills("--kills", "6", "--kinds", "plain")


@pytest.mark.slow
def test_three_hundred_kills() -> None:
    assert kills("--kills", "300").count("faults 0") == 7
