"""Written environments in renders: every direction in its place, and a ball that was rendered."""

from __future__ import annotations

import math

import numpy as np
import pytest

import daguerre as dg
from tests.support.pictures.light_probes import ball_picture, grid, mirror, save, world
from tests.support.scene.scenes import sphere

FOV = math.degrees(2 * math.atan(240 / 600))
#: Columns of world_from_camera: right, up, back.
LOOKS = {
    "+z": ((-1, 0, 0), (0, 1, 0), (0, 0, -1)),
    "+x": ((0, 0, 1), (0, 1, 0), (-1, 0, 0)),
    "up": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
}


def seen(environment, axes):
    """The middle of a render that looks into an environment alone, 20 degrees high."""
    scene = dg.Scene()
    scene.set_environment(environment)
    pose = np.eye(4)
    pose[:3, :3] = np.array(axes).T
    focal = 12 / math.tan(math.radians(10))
    camera = dg.Camera(lens="pinhole", focal_length=focal, sensor_size=(36, 24), transform=pose)
    scene.add_camera("c", camera)
    return dg.render(scene, resolution=(48, 32), spp=256).rgb


@pytest.mark.parametrize("way", LOOKS)
def test_the_renderer_sees_what_the_camera_saw(tmp_path, way):
    """Turns red with a mirrored direction, and with a frame that looks along +z."""
    path = save(tmp_path / "ball.exr", ball_picture(mirror(world)))
    made = dg.light_probe(path, ball="mirror", fov=FOV, res=512)
    made.save(tmp_path / "env.exr")
    picture = seen(tmp_path / "env.exr", LOOKS[way])
    right, up, back = (np.array(axis, float) for axis in LOOKS[way])
    scale = math.tan(math.radians(10)) / 16
    for row, column in ((4, 6), (16, 24), (27, 41)):
        d = right * (column + 0.5 - 24) * scale + up * (16 - row - 0.5) * scale - back
        truth = world(d / np.linalg.norm(d))
        patch = picture[row - 2 : row + 3, column - 2 : column + 3].mean(axis=(0, 1))
        assert patch == pytest.approx(truth, rel=0.01)


def test_a_rendered_ball_gives_its_environment_back(tmp_path):
    """Daguerre photographs a mirror ball in a known world; the probe finds that world again."""
    scene = dg.Scene()
    scene.set_environment(world(grid(256, 128)).astype(np.float32))
    points, triangles, normals = sphere(96)
    place = np.eye(4)
    place[:3, 3] = (0.15, -0.1, -5)
    ball = scene.add_mesh(points, triangles, normals)
    scene.add_instance(ball, dg.Conductor(alpha=0.0), place)
    scene.add_camera("c", dg.Camera(lens="pinhole", focal_length=45, sensor_size=(36, 27)))
    frame = dg.render(scene, resolution=(320, 240), spp=16)
    frame.save(tmp_path / "ball.exr")
    fov = math.degrees(2 * math.atan(18 / 45))
    # Behind the ball its world looks much like its rim, so its outline is given.
    circle = (160 + 400 * 0.15 / 5, 120 + 400 * 0.1 / 5, 400 * math.tan(math.asin(1 / 5.0032)))
    made = dg.light_probe(
        tmp_path / "ball.exr", ball="mirror", fov=fov, circle=circle, res=256, sun="off"
    )
    back = np.array([-0.15, 0.1, 5]) / np.linalg.norm([-0.15, 0.1, 5])
    front = grid(256, 128) @ back > math.cos(math.radians(120))
    off = np.abs(made.image / world(grid(256, 128)) - 1)
    assert off[front].mean() < 0.01


def test_the_suns_light_and_its_map_agree_in_a_render(tmp_path):
    """White paper under the map with its sun, and under the map and the light of --sun-out."""
    d = grid(512, 256)
    toward = np.array([0.3, 0.8, 0.4]) / np.linalg.norm([0.3, 0.8, 0.4])
    disc = (d @ toward > math.cos(math.radians(1)))[..., None]
    save(tmp_path / "pano.exr", (np.ones((256, 512, 3)) + 5000 * disc).astype(np.float32))
    made = dg.light_probe(tmp_path / "pano.exr")
    assert made.sun is not None
    made.save_sun(tmp_path / "sun.glb")
    values = []
    for light in ("map", "both"):
        scene = dg.load(tmp_path / "sun.glb") if light == "both" else dg.Scene()
        scene.set_environment(made.rest if light == "both" else made.image)
        corners = np.array([(-9, 0, -9), (9, 0, -9), (9, 0, 9), (-9, 0, 9)], float)
        paper = scene.add_mesh(corners, np.array([(0, 2, 1), (0, 3, 2)]))
        scene.add_instance(paper, dg.Diffuse((0.5, 0.5, 0.5)))
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = np.array(LOOKS["up"]).T * (1, -1, -1), (0, 2, 0)
        scene.add_camera("down", dg.Camera(lens="pinhole", focal_length=100, transform=pose))
        values.append(dg.render(scene, camera="down", resolution=(16, 12), spp=256).rgb.mean())
    expected = 0.5 / math.pi * (math.pi + made.sun.lux * made.sun.direction[1])
    assert values == pytest.approx([expected, expected], rel=0.02)
