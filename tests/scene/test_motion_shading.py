"""Lamps, materials and skies over time: the blurred picture is the mean of still ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import InputError
from daguerre.setup.scene import build
from tests.support.pictures import statistical
from tests.support.scene import scenes

OPEN, CLOSE = 2.0, 2.5  # s
MOMENTS = 16
SIZE = (24, 16)


def keys(*pairs: tuple[float, Any]) -> Any:
    return dg.keys([(OPEN + s * (CLOSE - OPEN), value) for s, value in pairs])


def turned(degrees: float, x: float = 0.0, y: float = 1.5, z: float = -3.0) -> np.ndarray:
    """About the x axis, and placed."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[1, 0, 0, x], [0, c, -s, y], [0, s, c, z], [0, 0, 0, 1.0]])


def room(floor: Any = (0.5, 0.5, 0.5)) -> dg.Scene:
    """A floor that the camera looks down on."""
    scene = dg.Scene(time=OPEN)
    points, faces = scenes.quad(4)
    material = floor if isinstance(floor, dg.Material) else dg.Material(dg.Diffuse(floor))
    scene.add_instance(scene.add_mesh(points, faces), material, turned(-90, y=-1))
    return scene


def lamps() -> dg.Scene:
    scene = room()
    dims = dg.PointLight(intensity=keys((0, (8, 8, 8)), (0.6, (0, 2, 4)), (0.61, (0, 0, 0))))
    scene.add_light(dims, keys((0, turned(0, -1)), (1, turned(0, 1, 1))))
    spot = dg.SpotLight(intensity=(20, 20, 20), inner_angle=5, outer_angle=keys((0, 20), (1, 40)))
    scene.add_light(spot, keys((0, turned(-60)), (1, turned(-110))))
    grows = dg.PointLight(intensity=(4, 4, 4), radius=keys((0, 0.1), (1, 0.5)))
    scene.add_light(grows, keys((0, turned(0, -2, 0)), (1, turned(0, 2, 0))))
    return scene


def surfaces() -> dg.Scene:
    floor = dg.Gltf(base_color=keys((0, (1, 0, 0)), (1, (0, 1, 1))), metallic=0, roughness=0.8)
    scene = room(dg.Material(floor))
    glow = dg.Gltf(base_color=(0, 0, 0), emissive=keys((0, (9, 9, 9)), (0.3, (0, 0, 0))))
    points, faces = scenes.quad(0.5)
    scene.add_instance(scene.add_mesh(points, faces), dg.Material(glow), turned(90, y=0.5))
    mirror = dg.Conductor(alpha=keys((0, 0.05), (1, 0.4)))
    scene.add_instance(scene.add_mesh(points, faces), dg.Material(mirror), turned(-30, y=-0.6))
    scene.set_environment(color=(0.1, 0.1, 0.1))
    return scene


def skies() -> dg.Scene:
    scene = room()
    image = np.full((16, 32, 3), 0.05, np.float32)
    image[3:6, 4:8] = (9, 6, 3)
    scene.set_environment(image, scale=keys((0, 1), (1, 3)), rotation=keys((0, 0), (1, 200)))
    points, faces = scenes.quad(1)
    wall = dg.Material(dg.Diffuse((0.5, 0.5, 0.5)))
    scene.add_instance(scene.add_mesh(points, faces), wall, turned(0, y=0))
    return scene


def batches(scene_of: Callable[[float], tuple[dg.Scene, float]], count: int) -> np.ndarray:
    """Six pictures, each of the mean of ``count`` renders at stratified times."""
    random = np.random.default_rng(1)
    view = turned(-35, y=1.5, z=0)
    pictures = []
    for batch in range(6):
        total: Any = 0
        for i in range(count):
            share = (i + random.random()) / count
            scene, shutter_time = scene_of(OPEN + share * (CLOSE - OPEN))
            camera = dg.Camera(transform=view, lens="pinhole", focal_length=28)
            camera = camera.with_(shutter_time=shutter_time, shutter_offset=0)
            options = {"resolution": SIZE, "max_depth": 3, "filter": "box"}
            seed = 100 * batch + i
            total = total + dg.render(scene, camera, spp=64 // count, seed=seed, **options).rgb
        pictures.append(total / count)
    return np.array(pictures, np.float64)


@pytest.mark.parametrize("make", [lamps, surfaces, skies])
def test_blur_is_the_mean_of_still_pictures(make: Callable[[], dg.Scene]) -> None:
    scene = make()
    blurred = batches(lambda _: (scene, CLOSE - OPEN), 1)
    mean = batches(lambda t: (scene.at(t), 0.0), MOMENTS)
    assert statistical.differences(blurred, mean) == []
    first = batches(lambda _: (scene, 0.0), 1)
    assert statistical.differences(first, mean) != []


def test_what_does_not_change_in_the_interval_has_the_same_bits() -> None:
    scene = lamps()
    camera = dg.Camera(transform=turned(-35, y=1.5, z=0), shutter_time=0)
    a = dg.render(scene.at(9.0), camera, spp=4, resolution=SIZE).rgb
    plain = scene.at(9.0)
    plain.motion = type(plain.motion)()
    assert np.array_equal(a, dg.render(plain, camera, spp=4, resolution=SIZE).rgb)


@dataclass(frozen=True)
class Odd:
    """Fine at first, and then something else."""

    first: Any
    later: Any

    def at(self, time_s: float) -> Any:
        return self.first if time_s <= OPEN else self.later

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        return [t for t in (0.5 * (OPEN + CLOSE),) if begin < t < end]


@pytest.mark.parametrize(
    ("later", "message"),
    [
        (dg.Material(dg.Gltf(roughness=2)), "roughness"),
        (dg.Material(dg.Gltf(base_color="red")), "base_color"),  # type: ignore[arg-type]
        (dg.Material(dg.Diffuse()), "kind: cannot change .*, from Gltf to Diffuse"),
        (dg.Material(dg.Gltf(alpha_mode="mask")), "only numbers change"),
        ("paint", "wanted a Material"),
    ],
)
def test_materials_that_turn_into_something_else(later: Any, message: str) -> None:
    scene = room(dg.Material(dg.Gltf()))
    scene.motion.materials[0] = Odd(scene.materials[0], later)
    with pytest.raises(InputError, match=message):
        build(scene, (OPEN, CLOSE))


@pytest.mark.parametrize(
    ("later", "message"),
    [
        ((dg.SpotLight(), np.eye(4)), "kind: cannot change .*, from point to "),
        ((dg.PointLight(intensity=(-1, 0, 0)), np.eye(4)), "intensity"),
        ((None, np.eye(4)), "wanted a point, spot, directional or sphere light"),
    ],
)
def test_lights_that_turn_into_something_else(later: Any, message: str) -> None:
    scene = room()
    scene.add_light(dg.PointLight())
    scene.motion.lights[0] = Odd(scene.lights[0], later)
    with pytest.raises(InputError, match=message):
        build(scene, (OPEN, CLOSE))


def test_a_sky_keeps_its_picture() -> None:
    scene = room()
    scene.set_environment(np.ones((2, 4, 3)))
    first = scene.environment
    scene.set_environment(np.ones((2, 4, 3)))
    scene.motion.environment = Odd(first, scene.environment)
    with pytest.raises(InputError, match="environment: image"):
        build(scene, (OPEN, CLOSE))
