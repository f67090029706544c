"""Pictures in Blender's viewport, as far as they need no window."""

import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest

import daguerre as dg
from tests.support.blender import blender_extension
from tests.support.blender.blender_extension import FACTOR, camera, scene

bpy = pytest.importorskip("bpy", reason="no bpy in this Python")


@pytest.fixture(scope="module")
def module():
    return blender_extension.extension()


@pytest.fixture
def viewport(module):
    told = threading.Semaphore(0)
    found = module.viewport.Viewport(told.release)
    yield found
    found.close()


def shot_of(module, spp):
    settings = dg.RenderSettings.of(resolution=(400, 300), spp=spp, light_paths="off")
    return module.translation.Shot(scene(), camera(lens="pinhole"), settings, FACTOR)


def until(condition, seconds=20):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_the_picture_at_rest_is_that_of_a_render(module, viewport):
    shot = shot_of(module, 4)
    viewport.ask(shot, shot.camera, (80, 60))
    until(lambda: viewport.newest is not None and viewport.newest.rests)
    settings = shot.settings.with_(resolution=(80, 60))
    np.testing.assert_array_equal(
        viewport.newest.frame.rgb, dg.render(shot.scene, shot.camera, settings=settings).rgb
    )
    assert viewport.words == "4/4 spp"


def test_the_newest_request_wins_at_once(module, viewport):
    long, short = shot_of(module, 1_000_000), shot_of(module, 2)
    viewport.ask(long, long.camera, (400, 300))
    until(lambda: viewport.newest is not None)
    began = time.monotonic()
    viewport.ask(short, short.camera, (50, 40))
    until(lambda: viewport.newest.rests)
    assert time.monotonic() - began < 3
    assert viewport.newest.frame.rgb.shape == (40, 50, 3)


def test_a_request_that_cannot_be_drawn_is_told_and_the_next_is_drawn(module, viewport):
    shot = shot_of(module, 1)
    viewport.ask(shot, camera(lens="no-such-lens"), (50, 40))
    until(lambda: "no-such-lens" in viewport.words)
    viewport.ask(shot, shot.camera, (50, 40))
    until(lambda: viewport.newest is not None and viewport.newest.rests)


def test_closing_ends_the_thread(module):
    before = threading.active_count()
    found = module.viewport.Viewport(lambda: None)
    assert threading.active_count() == before + 1
    found.close()
    assert threading.active_count() == before


@pytest.mark.parametrize("unit_m", [1.0, 0.01])
def test_a_free_view_is_the_projection_of_the_region(module, unit_m):
    """A point of the world falls on the pixel where OpenGL's projection has it."""
    size, near, far, scale = (400, 250), 0.1, 100.0, 2.1
    projection = np.zeros((4, 4))
    projection[0, 0], projection[1, 1] = scale, scale * size[0] / size[1]
    projection[2, 2:] = -(far + near) / (far - near), -2 * far * near / (far - near)
    projection[3, 2] = -1
    angle = 0.4
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    world_from_view = np.eye(4)
    world_from_view[:3, :3] = turn @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    world_from_view[:3, 3] = 1, -5, 2
    view = np.linalg.inv(world_from_view)
    found = module.viewport.free_camera(view, projection, size, unit_m)
    point = np.array([-0.4, 1.5, 2.8, 1.0])
    clip = projection @ view @ point
    wanted = clip[:2] / clip[3]
    ours = np.linalg.inv(found.transform) @ [
        point[0] * unit_m, point[2] * unit_m, -point[1] * unit_m, 1
    ]  # fmt: skip
    on_film = found.focal_length * ours[:2] / -ours[2]
    np.testing.assert_allclose(on_film / (np.array(found.sensor_size) / 2), wanted, rtol=1e-12)
    assert abs(wanted).max() < 1  # the point is in the picture


def region(perspective="PERSP", is_perspective=True):
    eye = np.eye(4)
    data = SimpleNamespace(
        view_perspective=perspective, is_perspective=is_perspective,
        view_matrix=eye, window_matrix=eye,
    )  # fmt: skip
    return SimpleNamespace(region=SimpleNamespace(width=64, height=48), region_data=data)


def test_equal_views_are_equal_and_others_are_not(module):
    view_of, context = module.viewport.view_of, region()
    assert view_of(context, None) == view_of(region(), None)
    context.region_data.view_matrix = np.diag([1, 1, 1, 2.0])
    assert view_of(context, None) != view_of(region(), None)
    assert view_of(context, None).rectangle == (0, 0, 64, 48)


def test_an_orthographic_view_is_refused(module):
    with pytest.raises(dg.UsageError, match="orthographic"):
        module.viewport.view_of(region("ORTHO", is_perspective=False), None)


def test_a_pixel_of_the_camera_s_picture_is_one_of_the_screen(module, monkeypatch):
    frame = (10.2, 4.75, 40.0, 30.5)
    monkeypatch.setattr(module.viewport, "frame_of", lambda context, depsgraph: frame)
    view = module.viewport.view_of(region("CAMERA"), None)
    assert view.size == view.rectangle[2:] == (40, 30)
    assert view.rectangle[:2] == (10, 5)


def test_a_camera_s_frame_beyond_the_region_costs_no_more_pixels_than_the_region(
    module, monkeypatch
):
    """A user zooms into the frame without limit."""
    frame = (-6000, -4000, 16000, 8000)
    monkeypatch.setattr(module.viewport, "frame_of", lambda context, depsgraph: frame)
    view = module.viewport.view_of(region("CAMERA"), None)
    assert view.rectangle == frame
    assert view.size[0] * view.size[1] <= 64 * 48
    assert view.size[0] / view.size[1] == pytest.approx(2, rel=0.05)


def test_a_refused_view_says_why_and_no_older_picture_comes_back(module, viewport):
    shot = shot_of(module, 1_000_000)
    viewport.ask(shot, shot.camera, (400, 300))
    until(lambda: viewport.newest is not None)
    viewport.refuse(dg.UsageError("viewport: wanted a perspective view"))
    time.sleep(1.5)  # the painter shows a picture at least so often
    assert viewport.newest is None
    assert viewport.words == "viewport: wanted a perspective view"


def test_an_error_of_a_scene_leaves_nothing_to_draw(module, viewport, monkeypatch):
    viewport._shot = shot_of(module, 1)

    def broken(depsgraph):
        raise dg.InputError("mesh Cube: points: wanted finite numbers, got nan")

    monkeypatch.setattr(module.translation, "scene_of", broken)
    engine = SimpleNamespace(viewport=viewport)
    module.engine.DaguerreEngine.view_update(engine, None, None)
    assert "mesh Cube" in viewport.words
    viewport.draw(None, region(), None)
    assert viewport.newest is None
    assert "mesh Cube" in viewport.words
