"""The camera that a file without one gets."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre.framing import frame_everything

from . import scenes


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


def test_an_empty_scene_has_no_view() -> None:
    assert frame_everything(dg.Scene()) is None
