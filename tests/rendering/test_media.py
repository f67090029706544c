"""Media in pictures: fog, clouds and smoke against closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from tests.support.scene import scenes

CUBE = np.array([(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float)
SIDES = (
    *((0, 3, 1), (0, 2, 3), (4, 7, 6), (4, 5, 7), (0, 5, 4), (0, 1, 5)),
    *((2, 7, 3), (2, 6, 7), (0, 6, 2), (0, 4, 6), (1, 7, 5), (1, 3, 7)),
)
#: A pinhole whose whole film looks almost straight ahead.
NARROW = dg.Camera(lens="pinhole", focal_length=2000, sensor_size=(0.5, 0.5))


def box_of(medium: dg.Medium, z: float = -4.0, kind: Any = None) -> dg.Scene:
    """A cube of 2 m that the medium fills, before the camera."""
    scene = dg.Scene()
    material = dg.Material(kind or dg.Boundary(), interior=medium)
    scene.add_instance(scene.add_mesh(CUBE, SIDES), material, scenes.at(0, 0, z), name="cloud")
    return scene


def mean(scene: dg.Scene, samples: int = 256, camera: dg.Camera = NARROW, **options: Any) -> Any:
    """Mean colour of a small picture, cd/m2."""
    options = {"resolution": (8, 8), "filter": "box", **options}
    return dg.render(scene, camera, spp=samples, **options).rgb.mean((0, 1))


def grid(values: Any) -> dg.DensityGrid:
    """Densities in the cube."""
    transform = np.diag((2.0, 2.0, 2.0, 1.0))
    transform[:3, 3] = -1
    return dg.DensityGrid(values, transform)


def scattered_once(lamp: Any, scattering: float, extinction: float) -> float:
    """Luminance of a lamp of 1 cd in fog that scatters evenly, along -z from the origin."""
    t = (np.arange(400_000) + 0.5) / 400_000 * 100
    r = np.sqrt(lamp[0] ** 2 + lamp[1] ** 2 + (lamp[2] + t) ** 2)
    light = scattering / (4 * math.pi) * np.exp(-extinction * (t + r)) / r**2
    return float(light.mean() * 100)


def test_a_lamp_glows_in_fog_as_the_integral_says() -> None:
    scene = dg.Scene()
    scene.set_fog(dg.Medium((0.05,) * 3, (0.15,) * 3))
    lamp = (0.5, 0.2, -3.0)
    scene.add_light(dg.PointLight((1, 1, 1)), scenes.at(*lamp))
    expected = scattered_once(lamp, 0.15, 0.2)
    assert mean(scene, max_depth=1) == pytest.approx([expected] * 3, rel=0.01)


@pytest.mark.parametrize("density", [None, grid(np.ones((4, 5, 6)))])
def test_smoke_leaves_its_transmittance_in_each_colour(density: dg.DensityGrid | None) -> None:
    scene = box_of(dg.Medium((0.1, 0.4, 1.0), density=density))
    scene.set_environment(color=(1, 1, 1))
    red, green, blue = mean(scene)
    assert red > green > blue
    grey = box_of(dg.Medium((0.4,) * 3, density=density))
    grey.set_environment(color=(1, 1, 1))
    assert mean(grey) == pytest.approx([math.exp(-0.8)] * 3, rel=0.01)


def test_a_spectrum_is_taken_at_its_wavelengths() -> None:
    absorption = dg.Spectrum((380, 579.9, 580.1, 780), (0, 0, 50, 50))
    scene = box_of(dg.Medium(absorption))
    scene.set_environment(color=(1, 1, 1))
    red, _, blue = mean(scene)
    assert red < 0.1  # only what the green and blue of sRGB have in common with it is left
    assert blue > 0.9


@pytest.mark.parametrize("density", [None, grid(np.arange(60).reshape(3, 4, 5) / 30)])
def test_a_white_cloud_vanishes_in_a_white_world(density: dg.DensityGrid | None) -> None:
    scene = box_of(dg.Medium(scattering=(3, 3, 3), lobes=((0.7, 1), (-0.3, 0.5)), density=density))
    scene.set_environment(color=(1, 1, 1))
    assert mean(scene, max_depth=500) == pytest.approx([1] * 3, rel=0.01)


def test_a_flame_shines_by_its_emission() -> None:
    scene = box_of(dg.Medium((0.5,) * 3, emission=(2, 2, 2)))
    expected = (1 - math.exp(-1)) * 2 / 0.5
    assert mean(scene, samples=64) == pytest.approx([expected] * 3, rel=0.01)


def test_glass_keeps_fog_out_and_holds_its_own_medium() -> None:
    """A slab of index 1 refracts nothing: only media tell it from air."""
    tea = dg.Medium((1.0,) * 3)
    scene = box_of(tea, kind=dg.Dielectric(ior=1.0))
    scene.set_environment(color=(1, 1, 1))
    assert mean(scene, samples=64) == pytest.approx([math.exp(-2)] * 3, rel=0.01)


def test_a_moving_cloud_is_blurred_by_the_shutter() -> None:
    """It covers the axis half of the time."""
    scene = dg.Scene()
    cloud = dg.Material(dg.Boundary(), interior=dg.Medium((100,) * 3))
    path = dg.keys([(0.0, scenes.at(0, 0, -4)), (1.0, scenes.at(2, 0, -4))])
    scene.add_instance(scene.add_mesh(CUBE, SIDES), cloud, path)
    scene.set_environment(color=(1, 1, 1))
    camera = NARROW.with_(shutter_time=1.0)
    scene = scene.at(0.5)
    assert mean(scene, camera=camera) == pytest.approx([0.5] * 3, abs=0.03)


def test_alpha_of_fog_is_what_it_takes_away_and_truth_looks_through_its_faces() -> None:
    scene = box_of(dg.Medium((0.2,) * 3, (0.3,) * 3))
    scene.set_environment(color=(1, 1, 1))
    options: dict[str, Any] = {"resolution": (8, 8), "spp": 256, "filter": "box"}
    frame = dg.render(scene, NARROW, background="transparent", **options)
    assert float(frame.alpha.mean()) == pytest.approx(1 - math.exp(-1), rel=0.03)
    wall = scene.add_mesh(*scenes.quad(3, -9))
    scene.add_instance(wall, dg.Material(dg.Diffuse()))
    depth = dg.render(scene, NARROW, aovs=True, **options).aovs["depth.Z"]
    assert np.allclose(depth, 9, rtol=1e-4)


@pytest.mark.parametrize("density", [None, grid(np.ones((3, 3, 3)))])
def test_light_paths_find_what_the_camera_finds_in_fog(density: dg.DensityGrid | None) -> None:
    """A lamp and a lit floor, in fog and within a cloud: straight light, bounces, and both."""
    scene = box_of(dg.Medium((0.1, 0.2, 0.4), (0.2,) * 3, density=density), z=-3)
    scene.set_fog(dg.Medium((0.02,) * 3, (0.05,) * 3))
    floor = scene.add_mesh(*scenes.quad(4))
    turned = np.array([[1, 0, 0, 0], [0, 0, 1, -0.5], [0, -1, 0, -3], [0, 0, 0, 1.0]])
    scene.add_instance(floor, dg.Material(dg.Diffuse((0.6, 0.5, 0.4))), turned)
    scene.add_light(dg.SphereLight((3, 2.4, 2), radius=0.4), scenes.at(0, 0.3, -3.2))
    camera = dg.Camera(
        lens="thin", focal_length=35, sensor_size=(24, 24), f_stop=2, focus_distance=6
    )
    options: dict[str, Any] = {"camera": camera, "resolution": (12, 12), "samples": 512}
    alone = mean(scene, light_paths="off", **options)
    assert mean(scene, light_paths=(3000, 3000), **options) == pytest.approx(alone, rel=0.02)
    assert mean(scene, light_paths=(3000, 0), **options) == pytest.approx(alone, rel=0.02)


def test_media_refuse_catchers_which_do_not_know_them() -> None:
    scene = box_of(dg.Medium((1,) * 3))
    scene.set_catcher("cloud")
    with pytest.raises(dg.InputError, match="catchers cannot be used in a scene with media"):
        mean(scene, samples=1)


def test_endless_fog_says_that_it_keeps_out_the_sky() -> None:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    scene.set_fog(dg.Medium((1,) * 3))
    session = dg.Session(scene, NARROW, resolution=(4, 4))
    assert any(
        "endless fog absorbs all light of the environment" in note for note in session.warnings
    )
    assert mean(scene, samples=1) == pytest.approx([0] * 3)
