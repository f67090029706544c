"""The pilot that chooses numbers of light paths: what it depends on, and what it chooses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.rendering.light_paths import OFF
from daguerre.rendering.session import Session
from tests.support.scene import scenes

SIZE = (240, 160)
CAMERA = dg.Camera(lens="thin", focal_length=50, f_stop=2.0, focus_distance=1.2)


def lamps(radius: float) -> dg.Scene:
    """Lamps 3 m away over a wall that a larger lamp lights, out of the frame."""
    scene = dg.Scene()
    points, faces = scenes.quad(3, -4)
    scene.add_instance(scene.add_mesh(points, faces), dg.Material(dg.Diffuse((0.5, 0.5, 0.5))))
    for x in np.linspace(-0.8, 0.8, 9):
        luminance = 0.03 / (np.pi * radius**2)
        scene.add_light(dg.SphereLight((luminance,) * 3, radius), scenes.at(float(x), 0.2, -3.0))
    scene.add_light(dg.SphereLight((20, 20, 20), 0.3), scenes.at(0, 3.0, -2.0))
    return scene


def plan(scene: dg.Scene, camera: dg.Camera = CAMERA, **options: Any) -> tuple[float, float]:
    return Session(scene, camera, **({"resolution": SIZE} | options)).light_paths


def test_small_lamps_out_of_focus_get_light_paths() -> None:
    assert plan(lamps(0.002))[0] >= 1000


@pytest.mark.parametrize("change", [{"threads": 3}, {"aovs": True}, {"seed": 7}, {"seed": 8}])
def test_the_plan_depends_on_neither_threads_nor_seed(change: dict[str, Any]) -> None:
    scene = lamps(0.002)
    assert plan(scene, threads=1) == plan(scene, **change) != OFF


def test_a_crop_has_its_share_of_the_light_paths() -> None:
    scene = lamps(0.002)
    whole, part = plan(scene), plan(scene, crop=(10, 20, 90, 60))
    share = 80 * 40 / (SIZE[0] * SIZE[1])
    assert whole[0] > 0
    assert part == pytest.approx([m * share for m in whole], rel=1e-12)


def test_nothing_where_nothing_shines_that_light_could_start_from() -> None:
    assert plan(scenes.furnace(dg.Material(dg.Diffuse((0.5, 0.5, 0.5))))) == OFF
    assert plan(scenes.furnace(), dg.Camera(lens="pinhole")) == OFF
    assert plan(dg.Scene()) == OFF
    assert plan(lamps(0.002), dg.Camera(transform=np.diag([-1.0, 1, -1, 1]))) == OFF  # behind it


def test_a_plan_that_is_told_is_kept() -> None:
    assert plan(lamps(0.002), light_paths="off") == OFF
    assert plan(lamps(0.002), light_paths=(17, 3)) == (17, 3)


def caustic(material: dg.Material) -> dg.Scene:
    """A small lamp over a ball on a floor."""
    scene = dg.Scene()
    points, faces = scenes.quad(1)
    floor = np.array([[1, 0, 0, 0], [0, 0, 1, -0.2], [0, -1, 0, -1.2], [0, 0, 0, 1.0]])
    scene.add_instance(
        scene.add_mesh(points, faces), dg.Material(dg.Diffuse((0.6, 0.6, 0.6))), floor
    )
    points, faces, normals = scenes.sphere(48, 0.12)
    ball = scene.add_mesh(points, faces, normals=normals)
    scene.add_instance(ball, material, scenes.at(0, -0.07, -1.2))
    scene.add_light(dg.SphereLight((4000, 4000, 4000), 0.01), scenes.at(0.4, 0.8, -1.4))
    return scene


def test_light_paths_with_bounces_go_where_glass_gathers_light() -> None:
    assert plan(caustic(dg.Material(dg.Dielectric(1.5))))[1] >= 1000
    assert plan(caustic(dg.Material(dg.Diffuse((0.6, 0.6, 0.6)))))[1] == 0
