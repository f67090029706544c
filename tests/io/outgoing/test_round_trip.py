"""Scenes written for pbrt and Mitsuba, read back by our own readers: they are the same."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.files import formats
from tests.support import outgoing_scenes

SIZE = (48, 32)


def reader_of(suffix: str) -> None:
    """Skips without a reader of these scenes."""
    rows = formats.formats("scene")
    if not any(row.reads and suffix in row.suffixes for row in rows):
        pytest.skip(f"there is no reader of {suffix} here")


def triangles(scene: dg.Scene) -> np.ndarray:
    """Corners in the world, sides as front faces go, sorted: shape (N, 9)."""
    found = []
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        world = mesh.positions @ instance.transform[:3, :3].T + instance.transform[:3, 3]
        corners = world[mesh.indices.reshape(-1, 3)]
        if np.linalg.det(instance.transform[:3, :3]) < 0:
            corners = corners[:, ::-1]
        # The corner that is lowest in x + 2 y + 4 z comes first; a turn keeps the side.
        first = np.round(corners @ (1.0, 2.0, 4.0), 4).argmin(axis=1)
        turn = (first[:, None] + np.arange(3)) % 3
        found.append(np.take_along_axis(corners, turn[:, :, None], axis=1).reshape(-1, 9))
    flat = np.concatenate(found)
    return flat[np.lexsort(np.round(flat, 4).T)]


SCENES = [
    outgoing_scenes.box,
    outgoing_scenes.mirrored,
    outgoing_scenes.depth,
    outgoing_scenes.glass,
]


@pytest.mark.parametrize("suffix", [".pbrt", ".xml"])
@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
def test_meshes_and_camera_come_back(
    make: Callable[[], dg.Scene], suffix: str, tmp_path: Path
) -> None:
    reader_of(suffix)
    scene = make()
    if suffix == ".xml":  # there a shifted thin lens is a window of a larger film
        scene.cameras["main"] = scene.camera().with_(shift=(0.0, 0.0))
    file = tmp_path / f"scene{suffix}"
    dg.export_scene(scene, file, resolution=SIZE, spp=4)
    again = dg.load(file)
    np.testing.assert_allclose(triangles(again), triangles(scene), atol=2e-6)
    ours, theirs = (dg.raymap(one.camera(), SIZE, frame="world")
                    for one in (scene, again))  # fmt: skip
    np.testing.assert_allclose(theirs.origin, ours.origin, atol=1e-6)
    np.testing.assert_allclose(theirs.direction, ours.direction, atol=1e-6)
    assert (scene.camera().lens == "thin") == (again.camera().lens != "pinhole")


@pytest.mark.parametrize("suffix", [".pbrt", ".xml"])
def test_light_comes_back(suffix: str, tmp_path: Path) -> None:
    """One unit: 1 cd/m2 of the world, a lamp's candelas, lux of the sun."""
    reader_of(suffix)
    scene = outgoing_scenes.room()
    scene.add_light(dg.PointLight((3.0, 2.0, 1.0)), outgoing_scenes.placed(0.1, 0.2, 0.3))
    scene.add_light(dg.DirectionalLight((5.0, 6.0, 7.0)), dg.look_at((1, 2, 3), (0, 0, 0)))
    scene.set_environment(color=(0.5, 1.0, 2.0), scale=3.0)
    file = tmp_path / f"scene{suffix}"
    dg.export_scene(scene, file, resolution=SIZE, spp=4)
    again = dg.load(file)
    lamps = {type(light): (light, place) for light, place in again.lights}
    lamp, place = lamps[dg.PointLight]
    np.testing.assert_allclose(lamp.intensity, (3, 2, 1), rtol=1e-5)
    np.testing.assert_allclose(place[:3, 3], (0.1, 0.2, 0.3), atol=1e-6)
    sun, place = lamps[dg.DirectionalLight]
    np.testing.assert_allclose(sun.illuminance, (5, 6, 7), rtol=1e-5)
    toward = place[:3, 2] / np.linalg.norm(place[:3, 2])
    np.testing.assert_allclose(toward, np.array((1, 2, 3)) / np.sqrt(14), atol=1e-6)
    sky = again.environment
    assert sky is not None
    assert sky.color is not None
    np.testing.assert_allclose(np.array(sky.color) * sky.scale, (1.5, 3, 6), rtol=1e-5)
    shining = [m for m in again.materials if max(m.emission) > 0]
    assert len({m.emission for m in shining}) == 1
    np.testing.assert_allclose(shining[0].emission, (20, 18, 15), rtol=1e-5)
