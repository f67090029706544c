"""The scenes of scenes/lens_scenes.py: the same every time, read without a note, and lit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from tests.support.scene.example_scenes import make

SCENES = ("arcade", "lamps", "long_table", "photographer", "caustics", "blocks")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("lens_scenes")
    make("lens_scenes", made)
    return made


def test_same_bytes_every_time(folder: Path, tmp_path: Path) -> None:
    make("lens_scenes", tmp_path)
    for name in SCENES:
        assert (tmp_path / f"{name}.glb").read_bytes() == (folder / f"{name}.glb").read_bytes()
        assert (tmp_path / f"{name}.glb").stat().st_size < 5_000_000


@pytest.mark.parametrize("name", SCENES)
def test_loads_without_a_warning_and_shows_something(folder: Path, name: str) -> None:
    scene = dg.load(folder / f"{name}.glb")
    assert scene.warnings == []
    frame = dg.render(scene, "Camera", spp=4, resolution=(72, 48), max_depth=3)
    assert np.isfinite(frame.rgb).all()
    assert (frame.rgb.max(axis=2) > 0.01).mean() > (0.001 if name == "lamps" else 0.1)


def test_the_subject_of_the_arcade_lies_in_the_plane_of_focus(folder: Path) -> None:
    """Frame and chart at z = 0, as far away as shows half a metre of it."""
    scene = dg.load(folder / "arcade.glb")
    camera = scene.cameras["Camera"]
    assert camera.focus_distance == pytest.approx(camera.transform[2, 3], abs=1e-4)
    assert camera.focus_distance * 24 / camera.focal_length == pytest.approx(0.5, abs=1e-3)
    places = {i.name: np.asarray(i.transform)[:3, 3] for i in scene.instances}
    for name in ("frame", "chart"):
        assert abs(places[name][2]) < 0.002


def test_each_block_looks_equally_large(folder: Path) -> None:
    """So that focus alone tells near from far; their fronts are at 0.5, 1 and 4 m."""
    scene = dg.load(folder / "blocks.glb")
    camera = scene.camera()
    for letter, away in (("A", 0.5), ("B", 1.0), ("C", 4.0)):
        block = next(i for i in scene.instances if i.name == f"block {letter}")
        points = scene.meshes[block.mesh].positions @ block.transform[:3, :3].T
        size = float(np.ptp(points[:, 1]))
        front = camera.transform[2, 3] - block.transform[2, 3] - size / 2
        assert front == pytest.approx(away, rel=0.02)
        assert size / front == pytest.approx(0.16, rel=0.02)
