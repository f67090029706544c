"""The scene for the exposure triangle: the same made twice, dark without a sky, and turning."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def pinwheels(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("exposure")
    for part in ("a", "b"):
        script = [sys.executable, str(ROOT / "scenes" / "exposure.py"), "-o", str(folder / part)]
        subprocess.run(script, check=True, capture_output=True)
    first, second = (folder / part / "pinwheels.glb" for part in ("a", "b"))
    assert first.read_bytes() == second.read_bytes()
    return first


def test_pinwheels_turn_twice_a_second(pinwheels: Path) -> None:
    pictures = []
    for time in (0.3, 0.3 + 1 / 12, 0.3 + 1 / 6):  # every other sail has another colour
        scene = dg.load(pinwheels, time=time)
        assert not scene.warnings
        scene.set_environment(color=(40, 40, 40))
        camera = scene.camera().with_(lens="pinhole", shutter_time=0)
        frame = dg.render(scene, camera, resolution=(120, 80), spp=8, crop=(0, 10, 40, 70))
        pictures.append(frame.rgb)
    moved = np.abs(pictures[1] - pictures[0]).mean()
    again = np.abs(pictures[2] - pictures[0]).mean()
    assert again < 0.5 * moved


def test_pinwheels_are_dark_without_a_sky(pinwheels: Path) -> None:
    frame = dg.render(dg.load(pinwheels), resolution=(24, 16), spp=1)
    assert frame.rgb.max() == 0
