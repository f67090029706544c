"""Many pictures in one process: memory stays flat."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

#: Growth from the first tenth to the last, MB, of the process and of Python's objects. A frame of
#: 24 x 16 px that is kept takes 30 kB, its scene more: 270 of them would be 8 MB at least.
PROCESS_MB, OBJECTS_MB = 8.0, 2.0


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["renders", "frames"])
def test_memory_stays_flat(kind: str) -> None:
    run = subprocess.run(
        [sys.executable, "-m", "tests.faults.long_run", kind, "300"],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=True,
    )
    words = run.stdout.split("growth")[1].split()
    assert float(words[0]) < PROCESS_MB, run.stdout
    assert float(words[-2]) < OBJECTS_MB, run.stdout
