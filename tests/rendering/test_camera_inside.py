"""Cameras inside refracting solids: absorption from the first metre, and radiance of n^2."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.rendering.session import Session
from tests.support.scene.scenes import at, quad

CUBE = np.array([(x, y, z) for z in (-2, 2) for y in (-2, 2) for x in (-2, 2)], float)
SIDES = (
    *((0, 3, 1), (0, 2, 3), (4, 7, 6), (4, 5, 7), (0, 5, 4), (0, 1, 5)),
    *((2, 7, 3), (2, 6, 7), (0, 6, 2), (0, 4, 6), (1, 7, 5), (1, 3, 7)),
)
NARROW = dg.Camera(lens="pinhole", focal_length=2000, sensor_size=(0.5, 0.5))
N = 1.33
#: Light that a face of the water passes at right angles.
PASSED = 1 - ((N - 1) / (N + 1)) ** 2


def water(**changes: Any) -> dg.Material:
    """Clear water of which 2 m pass half of the light."""
    given: dict[str, Any] = {
        "base_color": (1, 1, 1), "metallic": 0, "roughness": 0, "transmission": 1,
        "thickness": 1, "ior": N, "attenuation_distance": 2, "attenuation_color": (0.5, 0.5, 0.5),
    }  # fmt: skip
    return dg.Material(dg.Gltf(**(given | changes)))


def tank(transform: Any = None, sides: Any = SIDES, **changes: Any) -> dg.Scene:
    """A cube of 4 m around the origin, in a white world."""
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    mesh = scene.add_mesh(CUBE, sides)
    scene.add_instance(mesh, water(**changes), transform, name="water")
    return scene


def mean(scene: dg.Scene, camera: dg.Camera = NARROW, **options: Any) -> float:
    given: dict[str, Any] = {"resolution": (8, 8), "spp": 64, "light_paths": "off"}
    return float(dg.render(scene, camera, **(given | options)).rgb.mean())


def test_a_camera_in_water_sees_what_is_outside_by_beer_lambert_and_n_squared() -> None:
    assert mean(tank()) == pytest.approx(0.5 * N**2 * PASSED, rel=0.01)
    near_the_wall = NARROW.with_(transform=at(0, 0, -1))
    assert mean(tank(), near_the_wall) == pytest.approx(0.5**0.5 * N**2 * PASSED, rel=0.01)
    outside = NARROW.with_(transform=at(0, 0, 5))  # 4 m of water, and two faces
    assert mean(tank(), outside) == pytest.approx(0.25 * PASSED**2 + 1 - PASSED, rel=0.01)


def test_a_lamp_in_the_same_water_is_dimmed_by_the_water_alone() -> None:
    scene = tank()
    points, triangles = quad(1.0)
    shines = dg.Material(dg.Diffuse((0, 0, 0)), emission=(1, 1, 1))
    scene.add_instance(scene.add_mesh(points, triangles), shines, at(0, 0, -1))
    assert mean(scene) == pytest.approx(0.5**0.5, rel=0.01)


def test_things_in_the_water_hide_no_wall() -> None:
    # The water around the camera is found behind the wall that it sees.
    scene = tank()
    points, triangles = quad(1.0)
    scene.add_instance(scene.add_mesh(points, triangles), dg.Diffuse((1, 1, 1)), at(0, 0, -1))
    dark = mean(scene)
    clear = tank(attenuation_distance=np.inf)
    clear.add_instance(clear.add_mesh(points, triangles), dg.Diffuse((1, 1, 1)), at(0, 0, -1))
    assert dark < 0.6 * mean(clear)


def test_the_water_that_passes_the_camera_counts_while_it_is_there() -> None:
    there = dg.keys(((0.0, at(0, 0, 0)), (0.0001, at(50, 0, 0))))
    camera = NARROW.with_(shutter_time=0.02)
    half = 0.5 * (0.5 * N**2 * PASSED) + 0.5
    assert mean(tank(there), camera, spp=1024) == pytest.approx(half, rel=0.03)


def test_one_eye_in_the_water() -> None:
    cameras = {
        "dry": NARROW.with_(transform=at(-2.05, 0, 0)),
        "wet": NARROW.with_(transform=at(-1.95, 0, 0)),
    }
    frames = dg.render_rig(tank(), cameras, resolution=(8, 8), spp=64, light_paths="off")
    assert frames["dry"].rgb.mean() == pytest.approx(1, rel=0.01)
    assert frames["wet"].rgb.mean() == pytest.approx(0.5 * N**2 * PASSED, rel=0.01)


def test_a_solid_in_the_solid_is_the_one_that_counts() -> None:
    scene = tank(attenuation_distance=np.inf)
    inner = scene.add_mesh(0.5 * CUBE, SIDES)
    scene.add_instance(inner, water(attenuation_distance=1), at(0, 0, 0), name="syrup")
    session = Session(scene, NARROW, resolution=(8, 8), spp=1, light_paths=1.0)
    assert any("'syrup'" in note and "light paths are off" in note for note in session.notes)


def test_light_paths_to_a_camera_in_water_are_off_and_a_note_says_so() -> None:
    session = Session(tank(), NARROW, resolution=(8, 8), spp=1, light_paths=1.0)
    assert session.light_paths == (0, 0)
    assert "light paths are off: the camera is inside 'water'" in session.notes
    auto = Session(tank(), NARROW, resolution=(8, 8), spp=1)
    assert "light paths are off: the camera is inside 'water'" in auto.notes
    off = Session(tank(), NARROW, resolution=(8, 8), spp=1, light_paths="off")
    assert not any("light paths" in note for note in off.notes)
    away = Session(tank(), NARROW.with_(transform=at(0, 0, 5)), resolution=(8, 8), light_paths=1.0)
    assert away.light_paths[0] > 0
    assert not any("inside" in note for note in away.notes)


def test_a_mesh_that_is_not_closed_is_told() -> None:
    scene = tank(sides=SIDES[:8])  # without two of its sides
    session = Session(scene, NARROW, resolution=(8, 8), spp=1)
    assert any("'water', a mesh that is not closed" in note for note in session.notes)
    closed = Session(tank(), NARROW, resolution=(8, 8), spp=1)
    assert not any("closed" in note for note in closed.notes)


@pytest.mark.parametrize("inside", [True, False], ids=["lamp inside", "lamp outside"])
@pytest.mark.parametrize("kind", ["ball", "point"])
def test_the_water_dims_ghosts_of_lamps(kind: str, inside: bool) -> None:
    """Water without refraction, and a lamp beside the frame: all light comes by ghosts."""
    place = np.array((0.5, 0.35, -1.2)) * (1 if inside else 3)
    camera = dg.Camera(lens="double-gauss-50mm-f2", f_stop=2, focus_distance=2)

    def ghosts(**changes: Any) -> float:
        scene = tank(ior=1.0, **changes)
        scene.set_environment(color=(0, 0, 0))
        lamp = (
            dg.PointLight((9, 9, 9)) if kind == "point" else dg.SphereLight((900, 900, 900), 0.05)
        )
        scene.add_light(lamp, at(*place))
        return mean(scene, camera, flare=4000, resolution=(24, 16), spp=16)

    wet_m = np.linalg.norm(place) * (1 if inside else 2 / 3.6)
    clear = ghosts(attenuation_distance=np.inf)
    assert clear > 0
    assert ghosts() / clear == pytest.approx(0.5 ** (wet_m / 2), rel=0.03)
