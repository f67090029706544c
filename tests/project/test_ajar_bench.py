"""The bench of the room behind a door: JSON, errors, and a lamp that the room cannot see."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg

BENCH = Path(__file__).resolve().parents[2] / "bench"


@pytest.fixture(autouse=True)
def bench_is_importable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(BENCH / "ajar_door"))
    monkeypatch.syspath_prepend(str(BENCH))


def test_json() -> None:
    sizes = ["--w", "16", "--h", "9", "--spp", "1", "--seeds", "2", "--reference-spp", "2"]
    command = [sys.executable, str(BENCH / "ajar.py"), "--json", "--only", "daguerre", *sizes]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    found = json.loads(done.stdout)["daguerre"]
    assert found["error"]["mean"] >= found["error"]["typical"] > 0
    assert found["rays"] > 16 * 9
    assert set(found["of_reference"]) == {"frame", "room"}


def test_odd_number_of_seeds_is_refused() -> None:
    command = [sys.executable, str(BENCH / "ajar.py"), "--seeds", "3"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2
    assert "--seeds: wanted an even number, got 3" in done.stderr


def test_errors_of_known_pictures() -> None:
    import ajar

    true = np.full((10, 10, 3), 0.3)
    pictures = [true + 0.1, true - 0.1]
    pictures[0][0, 0] += 10  # one spark, a hundredth of the frame
    found = ajar.errors(pictures, true)
    even = 0.2**2 / 2 / (0.3**2 + 0.01)
    assert found["typical"] == pytest.approx(even)
    assert found["mean"] == pytest.approx(0.99 * even + 0.01 * 10.2**2 / 2 / 0.1)


def test_most_of_the_room_does_not_see_the_lamp() -> None:
    """Light after one surface, against all light, left and right of the door."""
    import daguerre_side

    scene, camera = daguerre_side.scene(), daguerre_side.camera()
    left, right = [], []
    for depth in (1, 12):
        frame = dg.render(scene, camera, spp=16, resolution=(64, 36), max_depth=depth, seed=1)
        left.append(frame.rgb[:, :24].mean())
        right.append(frame.rgb[:, 44:].mean())
    assert left[0] < 0.1 * left[1]  # some of it lies on the table
    assert right[0] < 0.01 * right[1]
