"""Eyes of a stereo pair: beside the camera at all times, and turned in as Blender turns them."""

import numpy as np
import pytest

import daguerre as dg
from daguerre.blender.eyes import eye_of
from tests.support.blender import blender_extension

bpy = pytest.importorskip("bpy", reason="no bpy in this Python")


def turned(angle, place):
    """A transform that turns about y."""
    c, s = np.cos(angle), np.sin(angle)
    made = np.eye(4)
    made[[0, 0, 2, 2], [0, 2, 0, 2]] = c, s, -s, c
    made[:3, 3] = place
    return made


def test_an_eye_stays_beside_a_camera_that_moves_and_turns():
    beside = turned(0.02, (0.0325, 0, 0))
    path = dg.keys([(0, turned(0, (0, 1, 2))), (1, turned(1.2, (3, 1, 0)))])
    bend = dg.keys([(0, (0.0, 1.0)), (1, (2.0, 1.0))])
    camera = dg.Camera(path, lens="thin", shift=bend, focus_distance=dg.keys([(0, 1.0), (1, 3.0)]))
    camera = camera.evaluated_at(0.3)
    still = camera.frozen_at(0.3).with_(transform=camera.transform @ beside, shift=(1.1, 1.0))
    eye = eye_of(camera, still, 0.3)
    for time in np.linspace(0, 1, 11):
        ours, between = eye.frozen_at(time), camera.frozen_at(time)
        np.testing.assert_allclose(ours.transform, between.transform @ beside, atol=1e-12)
        assert ours.shift == pytest.approx((between.shift[0] + 0.5, 1.0))
        assert ours.focus_distance == between.focus_distance


def test_an_eye_of_a_camera_at_rest_rests():
    still = dg.Camera(turned(0.1, (1, 0, 0)))
    assert eye_of(dg.Camera(), still, 0.0) == still


@pytest.fixture
def shots(monkeypatch, tmp_path):
    """Renders the default scene in stereo, and returns the shots of its eyes."""
    bpy.ops.wm.read_factory_settings()
    extension = blender_extension.extension()
    extension.register()
    found = []

    def watched(*given):
        found.append(shot_of(*given))
        return found[-1]

    shot_of = extension.translation.shot_of
    monkeypatch.setattr(extension.translation, "shot_of", watched)

    def render():
        scene, found[:] = bpy.context.scene, []
        scene.render.engine, scene.render.use_multiview = "DAGUERRE", True
        scene.render.resolution_x = scene.render.resolution_y = 9
        scene.render.image_settings.file_format = "OPEN_EXR"
        scene.render.filepath, scene.daguerre.spp = str(tmp_path / "out.exr"), 1
        bpy.ops.render.render(write_still=True)
        assert len(found) == 2
        return found

    yield render
    extension.unregister()


def test_both_eyes_move_with_a_camera_of_blender(shots):
    thing, scene = bpy.context.scene.camera, bpy.context.scene
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
    for frame, x in ((0, 7.0), (2, 9.0)):
        thing.location.x, thing.rotation_euler.z = x, 0.4 * x
        thing.keyframe_insert("location", frame=frame)
        thing.keyframe_insert("rotation_euler", frame=frame)
    stereo = thing.data.stereo
    stereo.interocular_distance, stereo.pivot = 0.25, "CENTER"
    left, right = shots()
    path = left.scene.camera("Camera").motion["transform"]
    for time in (*path.times, path.times[:2].mean()):
        places = [shot.camera.frozen_at(time).transform for shot in (left, right)]
        middle = left.scene.camera("Camera").frozen_at(time).transform
        for place, side in zip(places, (-1, 1), strict=True):
            wanted = middle[:3, 3] + side * 0.125 * middle[:3, 0]
            np.testing.assert_allclose(place[:3, 3], wanted, atol=1e-5)
    ends = [left.camera.frozen_at(time).transform[0, 3] for time in path.times[[0, -1]]]
    assert abs(ends[1] - ends[0]) > 0.1


@pytest.mark.parametrize("mode", ["OFFAXIS", "TOE", "PARALLEL"])
def test_both_eyes_meet_at_blender_s_convergence(shots, mode):
    stereo = bpy.context.scene.camera.data.stereo
    stereo.convergence_mode, stereo.convergence_distance = mode, 3.0
    stereo.interocular_distance, stereo.pivot = 0.5, "CENTER"
    seen = []
    for shot in shots():
        rays = dg.raymap(shot.camera, (9, 9), frame="world")
        start, along = rays.origin[4, 4], rays.direction[4, 4]
        camera = shot.scene.camera("Camera").transform
        (x, y, z), (dx, dy, dz) = (
            np.linalg.inv(camera)[:3, :3] @ v for v in (start - camera[:3, 3], along)
        )
        far = (-3.0 - z) / dz
        seen.append(x + far * dx)
        assert y + far * dy == pytest.approx(0, abs=1e-4)
    wanted = (-0.25, 0.25) if mode == "PARALLEL" else (0, 0)
    assert seen == pytest.approx(wanted, abs=2e-3)
