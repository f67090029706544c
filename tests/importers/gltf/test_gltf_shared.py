"""The two real scenes, where the folder with shared data is present."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from daguerre.importers.gltf import reader as gltf
from daguerre.scene.lights import SpotLight

SCENES = Path(__file__).parents[4] / "shared" / "data" / "scenes"
pytestmark = pytest.mark.skipif(not SCENES.is_dir(), reason="../shared/data/scenes is not here")


def test_chess_set():
    scene = gltf.read(SCENES / "open_chess_set_512.glb")
    assert len(scene.instances) == 49
    assert sum(len(scene.meshes[i.mesh].indices) for i in scene.instances) > 286_000
    assert len(scene.materials) == 13
    assert len(scene.textures) == 39
    assert {t.pixels.shape for t in scene.textures} == {(512, 512, 3)}
    assert [t.srgb for t in scene.textures[:3]] == [True, False, False]
    camera = scene.camera()
    assert scene.default_camera == "Camera"
    assert scene.camera("cam50") is camera
    assert (camera.focal_length, camera.sensor_size) == (50, (36, 24))
    assert (camera.f_stop, camera.focus_distance) == (2, 0.6)
    assert camera.transform[:3, 3] == pytest.approx([0.38, 0.22, 0.52])
    for mesh in scene.meshes:
        assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1, abs=1e-5)


def test_chess_set_moves():
    a, b = (gltf.read(SCENES / "open_chess_set_512.glb", time=t) for t in (0.0, 0.5))
    moved = [
        name
        for name in a.node_positions
        if not np.allclose(a.node_positions[name], b.node_positions[name])
    ]
    assert moved == ["White_KnightL_Geom_Render", "Camera"]
    (knight,) = b.nodes["White_KnightL_Geom_Render"]
    assert b.instances[knight].transform[:3, 3] == pytest.approx(
        b.node_positions["White_KnightL_Geom_Render"]
    )


def test_spinning_glass_cube():
    scene = gltf.read(SCENES / "spinning_glass_cube.glb", time=0.5)
    glass = scene.materials[0].kind
    assert (glass.transmission, glass.ior, glass.thickness) == (1, 1.45, 1)
    assert glass.dispersion > 0
    assert scene.warnings == []
    light, place = scene.lights[0]
    assert isinstance(light, SpotLight)
    assert light.intensity == pytest.approx((100, 80, 60))
    assert light.outer_angle == pytest.approx(math.degrees(0.5))
    assert place[:3, 3].tolist() == [2, 3, 2]
    camera = scene.camera("cam")
    assert camera.f_stop == 1.4
    assert camera.focal_length == pytest.approx(12 / math.tan(0.3))
    turn = scene.instances[0].transform
    assert np.linalg.det(turn[:3, :3]) == pytest.approx(1)
    assert not np.allclose(turn, np.eye(4))
