"""The camera that a file without one gets."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.scene.framing import bounds, frame_everything
from tests.support.scene import scenes


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_everything_is_in_view(scale: float) -> None:
    scene = dg.Scene()
    points, faces, normals = scenes.sphere(8)
    mesh = scene.add_mesh(points, faces, normals)
    for place in ((-3, 0, 1), (2, 4, -5)):
        transform = np.diag([scale, scale, scale, 1.0])
        transform[:3, 3] = np.array(place) * scale
        scene.add_instance(mesh, dg.Material(dg.Diffuse((1, 1, 1))), transform)
    scene.set_environment(color=(1, 1, 1))
    camera = frame_everything(scene)
    assert camera is not None
    frame = dg.render(scene, camera, resolution=(48, 32), spp=4, aovs=True)
    border = np.ones((32, 48), bool)
    border[1:-1, 1:-1] = False
    assert frame.alpha[border].max() == 0
    assert set(np.unique(frame.aovs["object_id"])) == {0, 1, 2}


def test_bounds_are_those_of_the_corners() -> None:
    rng = np.random.default_rng(5)
    scene = dg.Scene()
    meshes = [scene.add_mesh(rng.normal(size=(9, 3)) * (1, 2, 3) + k, [0, 1, 2]) for k in (0, 5)]
    wanted = []
    for mesh in meshes * 3:
        transform = np.eye(4)
        transform[:3] = rng.normal(size=(3, 4))
        scene.add_instance(mesh, None, transform)
        points = scene.meshes[mesh].positions
        box = np.array(np.meshgrid(*zip(points.min(axis=0), points.max(axis=0), strict=True)))
        wanted.append(transform[:3, :3] @ box.reshape(3, 8) + transform[:3, 3:])
    corners = np.concatenate(wanted, axis=1)
    low, high = bounds(scene)
    assert low == pytest.approx(corners.min(axis=1))
    assert high == pytest.approx(corners.max(axis=1))
    assert bounds(dg.Scene()) is None


def test_an_empty_scene_has_no_view() -> None:
    assert frame_everything(dg.Scene()) is None


TWO_BALLS = """<scene version="3.0.0">
  <shape type="sphere"><point name="center" x="-4" y="0" z="0"/></shape>
  <shape type="sphere"><point name="center" x="4" y="0" z="0"/></shape>
</scene>"""


def test_a_file_without_a_camera_is_in_focus(tmp_path: Path) -> None:
    """Between the balls the middle ray meets nothing; a camera of the file's own stays at far."""
    path = tmp_path / "balls.xml"
    path.write_text(TWO_BALLS)
    scene = dg.load(path)
    frame = dg.render(scene, resolution=(12, 8), spp=1)
    distance = float(np.linalg.norm(scene.camera().transform[:3, 3]))
    assert frame.metadata["focus"] == pytest.approx(distance, rel=1e-3)
    scene.add_camera("own", scene.camera())
    frame = dg.render(scene, "own", resolution=(12, 8), spp=1)
    assert math.isinf(frame.metadata["focus"])
