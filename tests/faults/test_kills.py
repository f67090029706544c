"""Kills at random instants: few of them in every run, 300 with the slow tests."""

from __future__ import annotations

import sys

import pytest

from .process import run


def kills(*words: str) -> str:
    """Runs them in a process that has drawn nothing, since its forks must draw; the table."""
    done = run([sys.executable, "-m", "tests.faults.kills", *words])
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_a_few_kills() -> None:
    assert "plain: 6 kills" in kills("--kills", "6", "--kinds", "plain")


@pytest.mark.slow
def test_three_hundred_kills() -> None:
    assert kills("--kills", "300").count("faults 0") == 7
