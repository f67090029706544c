"""Hostile files through one process: nothing stays behind; planted leaks are found."""

from __future__ import annotations

import os
import tempfile
import threading
from collections.abc import Callable

import pytest

from tests.fuzz import uses

from . import soak

KEPT: list[object] = []
LEAKS: dict[str, Callable[[], object]] = {
    "memory": lambda: bytearray(b"x" * 3_000_000),
    "files": lambda: os.open("/dev/null", os.O_RDONLY),
    "temporary": lambda: tempfile.mkdtemp(),
    "threads": lambda: threading.Thread(target=threading.Event().wait, daemon=True).start(),
}


@pytest.mark.slow
def test_nothing_stays_behind() -> None:
    done = soak.soak(["json", "calibration", "exif", "picture", "ply"], 60, 5, every=1)
    assert done.faults == []
    assert done.tried > 100


@pytest.mark.parametrize("leak", ["none", *LEAKS])
def test_planted_leaks_are_found(leak: str, monkeypatch: pytest.MonkeyPatch) -> None:
    made = LEAKS.get(leak, lambda: None)
    monkeypatch.setattr(uses, "calibrated", lambda path: KEPT.append(made()))
    done = soak.soak(["calibration"], 4, 5, every=0.2)
    for one in KEPT:
        if isinstance(one, int):
            os.close(one)
    KEPT.clear()
    assert [fault.partition(":")[0] for fault in done.faults] == [leak] * (leak != "none")
