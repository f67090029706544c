"""Environments by their illuminance on the ground."""

from __future__ import annotations

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli.flags.scene import SceneFlags
from daguerre.scene.illuminance import illuminance


def floor() -> tuple[dg.Scene, dg.Camera]:
    """A wide grey floor, seen from above."""
    scene = dg.Scene()
    corners = np.array([(-9, 0, -9), (9, 0, -9), (9, 0, 9), (-9, 0, 9)], float)
    mesh = scene.add_mesh(corners, np.array([(0, 2, 1), (0, 3, 2)]))
    scene.add_instance(mesh, dg.Material(dg.Diffuse((0.5, 0.5, 0.5))))
    down = np.array([[1, 0, 0, 0], [0, 0, 1, 3], [0, -1, 0, 0], [0, 0, 0, 1.0]])
    return scene, dg.Camera(down, lens="pinhole")


def test_an_even_sky_has_pi_times_its_luminance() -> None:
    scene = dg.Scene()
    scene.set_environment(color=(2, 2, 2), scale=50)
    assert illuminance(scene.environment) == pytest.approx(math.pi * 100)
    scene.set_environment(color=(0, 1, 0))  # Rec.709's green has 0.7152 of white's luminance
    assert illuminance(scene.environment) == pytest.approx(math.pi * 0.7152, rel=1e-3)
    for height in (1, 2, 3, 64, 515):
        scene.set_environment(np.full((height, 2 * height, 3), 2, np.float32), scale=50)
        assert illuminance(scene.environment) == pytest.approx(math.pi * 100)


def test_the_ground_gets_the_lux_that_were_asked_for() -> None:
    """A picture with a bright patch: luminance of the floor = reflectance E / pi."""
    rng = np.random.default_rng(4)
    image = rng.random((16, 32, 3)).astype(np.float32)
    image[3, 4] = 40
    image[12:] = 7  # below the horizon
    scene, eye = floor()
    scene.set_environment(image, lux=1000.0)
    assert illuminance(scene.environment) == pytest.approx(1000)
    frame = dg.render(scene, eye, resolution=(8, 8), spp=1024, max_depth=2)
    assert frame.xyz is not None
    assert frame.xyz[..., 1].mean() == pytest.approx(0.5 * 1000 / math.pi, rel=0.02)


def test_flags_set_what_the_ground_gets(tmp_path) -> None:
    from tests.support.formats.make_gltf import Builder

    path = Builder().glb(tmp_path / "s.glb")
    scene = SceneFlags(sky="1,0.5,0.2", env_lux="500").load(path)
    assert illuminance(scene.environment) == pytest.approx(500)
    for flags, message in (
        ({"sky": "1,1,1", "env_lux": "500", "env_scale": 2.0}, "--env-scale and --env-lux"),
        ({"env_lux": "500"}, "--env-lux needs an environment: --env or --sky"),
        ({"sky": "1,1,1", "env_lux": "-1"}, "--env-lux: wanted at least 0"),
        ({"sky": "0,0,0", "env_lux": "9"}, "--env-lux: no light comes from above the horizon"),
        ({"sky": "1,1,1", "env_lux": "bright"}, "--env-lux: wanted an illuminance"),
    ):
        with pytest.raises(dg.DaguerreError, match=message):
            SceneFlags(**flags).load(path)


def test_lux_and_scale_are_rivals() -> None:
    scene = dg.Scene()
    with pytest.raises(dg.UsageError, match="either scale or lux"):
        scene.set_environment(color=(1, 1, 1), lux=100, scale=2.0)
    with pytest.raises(dg.UsageError, match="environment: lux"):
        scene.set_environment(color=(1, 1, 1), lux=math.nan)
