"""Scenes written for Mitsuba, drawn by it and by us: the pictures have the same numbers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from tests.support.formats import mitsuba_pictures
from tests.support.scene import outgoing_scenes

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not mitsuba_pictures.installed(), reason="needs mitsuba, a test extra"),
]
SPP = 128
#: Scene, and the largest difference of its blocks and their median, as shares.
SCENES: dict[str, tuple[Callable[[], dg.Scene], float, float]] = {
    "box": (outgoing_scenes.box, 0.05, 0.01),
    "textures": (outgoing_scenes.textures, 0.05, 0.01),
    "glass": (outgoing_scenes.glass, 0.05, 0.015),
    "metals": (outgoing_scenes.metals, 0.05, 0.015),
    "sky": (outgoing_scenes.sky, 0.05, 0.01),
    "mirrored": (outgoing_scenes.mirrored, 0.05, 0.01),
    "depth": (outgoing_scenes.depth, 0.05, 0.01),
    "lamps": (outgoing_scenes.lamps, 0.05, 0.01),
    "coats": (outgoing_scenes.coats, 0.05, 0.015),
    "layered": (outgoing_scenes.layered, 0.05, 0.015),
}


@pytest.mark.parametrize("name", SCENES)
def test_pictures_agree(name: str, tmp_path: Path) -> None:
    make, most, median = SCENES[name]
    scene = make()
    size = outgoing_scenes.SIZE
    file = tmp_path / "scene.xml"
    dg.export_scene(scene, file, resolution=size, spp=SPP)
    theirs = mitsuba_pictures.blocks(mitsuba_pictures.draw(file))
    frame = dg.render(scene, resolution=size, spp=SPP, filter="box", light_paths="off")
    ours = mitsuba_pictures.blocks(frame.rgb)
    error = np.abs(theirs - ours) / np.maximum(ours, 0.02 * ours.max())
    assert error.max() < most, np.round(error.max(axis=2), 3)
    assert np.median(error) < median
