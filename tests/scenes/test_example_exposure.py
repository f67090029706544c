"""The scene for the exposure triangle: the same made twice, dark without a sky, and turning."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from tests.support.scene.example_scenes import made_twice


@pytest.fixture(scope="module")
def pinwheels(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made_twice("exposure", tmp_path_factory.mktemp("exposure")) / "pinwheels.glb"


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
