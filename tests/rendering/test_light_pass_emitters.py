"""Camera rays and light paths find one picture of emitters of every kind, and while things move.

How pictures are compared: ``light_proof.py``; through every lens: ``test_light_pass_proof.py``.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.scene.materials import Gltf, TextureSlot
from tests.support.pictures.light_proof import (
    CLOSE,
    SIZE,
    SMALL,
    Case,
    ball,
    by_chance,
    check,
    glass,
    lamp,
    pictures,
    thin,
    wall,
)
from tests.support.pictures.statistical import differences
from tests.support.scene import scenes

Matrix = NDArray[np.float64]


def turn(degrees: float, axis: int) -> Matrix:
    """A rotation about x, y or z."""
    a, i, j = np.radians(degrees), (axis + 1) % 3, (axis + 2) % 3
    out = np.eye(4)
    out[i, i], out[i, j], out[j, i], out[j, j] = np.cos(a), -np.sin(a), np.sin(a), np.cos(a)
    return out


def card(scene: dg.Scene, material: Any, transform: Matrix, half: float) -> None:
    """A square that faces +z, with all of the texture."""
    points, faces = scenes.quad(half)
    mesh = scene.add_mesh(points, faces, uv=[(0, 1), (1, 1), (1, 0), (0, 0)])
    scene.add_instance(mesh, material, transform)


def atlas(scene: dg.Scene) -> TextureSlot:
    """Bright texels, finer than pixels, in a corner of a dark image: at the rim of what shows that
    corner alone, the mean over a cone holds what no point of it shines with."""
    texels = np.zeros((128, 128, 3), np.uint8)
    texels[:64, :64] = np.random.default_rng(1).integers(160, 256, (64, 64, 3))
    half = (0.5, 0, 0, 0, 0.5, 0)
    return TextureSlot(scene.add_texture(texels, srgb=True), transform=half)


def holes(scene: dg.Scene) -> TextureSlot:
    """White, and transparent in squares."""
    texels = np.full((6, 6, 4), 255, np.uint8)
    texels[::2, ::2, 3] = texels[1::2, 1::2, 3] = 20
    return TextureSlot(scene.add_texture(texels, srgb=True, filter="nearest"))


def textured() -> dg.Scene:
    """In focus, behind it and aslant."""
    scene = dg.Scene()
    wall(scene)
    glow = Gltf(base_color=(0, 0, 0), emissive=(30, 20, 10), emissive_texture=atlas(scene))
    card(scene, glow, scenes.at(-0.05, 0.0, -CLOSE), 0.025)
    card(scene, glow, scenes.at(0.0, 0.045, -CLOSE), 0.007)
    card(scene, glow, scenes.at(0.06, 0.06, -2.2) @ turn(35, 1), 0.03)
    card(scene, glow, scenes.at(0.05, -0.03, -CLOSE) @ turn(-65, 0), 0.03)
    return scene


def faces() -> dg.Scene:
    """A card seen from its back that shines both ways, one that does not, and stretched balls."""
    scene = dg.Scene()
    wall(scene)
    for x, both in ((-0.06, True), (0.0, False)):
        glow = dg.Material(dg.Diffuse((0, 0, 0)), emission=(20, 30, 40), two_sided_emission=both)
        card(scene, glow, scenes.at(x, 0.04, -1.5) @ turn(160, 1), 0.02)
    points, triangles, normals = scenes.sphere(8, 0.012)
    mesh = scene.add_mesh(points, triangles, normals)
    glow = dg.Material(dg.Diffuse((0, 0, 0)), emission=(40, 20, 30))
    for x, z, angle in ((-0.05, -CLOSE, 30.0), (0.06, -2.0, 80.0)):
        stretch = turn(angle, 2) @ np.diag([2.5, 0.5, 1, 1]) @ turn(40, 2)  # and sheared
        scene.add_instance(mesh, glow, scenes.at(x, -0.02, z) @ stretch)
    return scene


def cutouts() -> dg.Scene:
    """Lamps behind cards with holes, and a card with holes that shines itself."""
    scene = dg.Scene()
    wall(scene)
    lamp(scene, (-0.06, 0.04, -1.8), 0.03, (300, 200, 100))
    lamp(scene, (0.06, 0.04, -1.8), 0.03, (300, 200, 100))
    slot = holes(scene)
    grey = Gltf(base_color=(0.3, 0.3, 0.3), base_color_texture=slot, metallic=0.0)
    card(scene, replace(grey, alpha_mode="mask"), scenes.at(-0.045, 0.03, -1.3), 0.03)
    card(scene, replace(grey, alpha_mode="blend"), scenes.at(0.045, 0.03, -1.3), 0.03)
    shining = replace(grey, emissive=(20, 10, 20), alpha_mode="blend")
    card(scene, shining, scenes.at(0.0, -0.03, -CLOSE), 0.02)
    card(scene, replace(shining, alpha_mode="mask"), scenes.at(0.06, -0.05, -2.0), 0.03)
    return scene


def everything() -> dg.Scene:
    """One of each, small: for a fast test."""
    scene = dg.Scene()
    wall(scene)
    glow = Gltf(base_color=(0, 0, 0), emissive=(60, 40, 20), emissive_texture=atlas(scene))
    card(scene, glow, scenes.at(-0.06, 0.03, -CLOSE), 0.008)
    both = dg.Material(dg.Diffuse((0, 0, 0)), emission=(20, 30, 40), two_sided_emission=True)
    card(scene, both, scenes.at(0.0, 0.05, -1.6) @ turn(160, 1), 0.025)
    points, triangles, normals = scenes.sphere(6, 0.012)
    stretch = turn(30, 2) @ np.diag([2.5, 0.5, 1, 1]) @ turn(40, 2)
    shine = dg.Material(dg.Diffuse((0, 0, 0)), emission=(40, 20, 30))
    mesh = scene.add_mesh(points, triangles, normals)
    scene.add_instance(mesh, shine, scenes.at(-0.06, -0.03, -CLOSE) @ stretch)
    lamp(scene, (0.09, -0.05, -1.8), 0.03, (300, 200, 100))
    grey = Gltf(base_color=(0.3, 0.3, 0.3), base_color_texture=holes(scene), metallic=0.0)
    card(scene, replace(grey, alpha_mode="mask"), scenes.at(0.065, -0.035, -1.3), 0.03)
    shining = replace(grey, emissive=(20, 10, 20), alpha_mode="blend")
    card(scene, shining, scenes.at(0.06, 0.03, -CLOSE), 0.02)
    return scene


def still_lamps() -> dg.Scene:
    """Lamps near and far, for cameras that change."""
    scene = dg.Scene(time=0.0)
    wall(scene)
    lamp(scene, (-0.05, 0.03, -CLOSE), 0.01, (40, 20, 10))
    lamp(scene, (0.09, -0.04, -2.2), 0.02, (200, 300, 400))
    card(
        scene,
        dg.Material(dg.Diffuse((0, 0, 0)), emission=(20, 40, 20)),
        scenes.at(0.03, 0.04, -1.5),
        0.015,
    )
    return scene


def over_time(first: Any, last: Any) -> dg.Keys:
    """From before the shutter opens to after it closes."""
    return dg.keys([(-0.05, first), (0.05, last)])


def calibrated(focal: float, k1: float) -> dg.Projection:
    """Projection of SMALL: 267 px are 50 mm."""
    return dg.Projection("opencv", SIZE, (focal, focal), None, (k1,))


#: Moves and turns, and lines are read out one after the other.
MOVED = {
    "transform": over_time(
        scenes.at(-0.03, 0.01, 0) @ turn(2, 1), scenes.at(0.03, 0, -0.1) @ turn(-1, 1) @ turn(6, 2)
    ),
    "shutter_time": 0.02,
    "rolling_shutter": dg.RollingShutter("top", readout_time=0.04),
}
PULL = {"focus_distance": over_time(1.0, 1.7), "shutter_time": 0.04}

TINY: dict[str, Any] = {"resolution": (32, 21)}
FAST = {
    "emitters": Case(everything, thin(), brightest=80, options=TINY),
    "moving camera that pulls its focus": Case(
        still_lamps,
        thin(**MOVED | {"focus_distance": PULL["focus_distance"]}),
        brightest=80,
        options=TINY,
    ),
}
MANY: dict[str, Any] = {"spp": (512, 128, 128), "brightest": 80}
SLOW = {
    "textured": Case(textured, thin(), **MANY),
    "textured, exact": Case(textured, glass(), **MANY),
    "textured, polynomial": Case(textured, glass(lens_model="polynomial"), **MANY),
    "either side": Case(faces, glass(), **MANY),
    "cutouts": Case(cutouts, glass(), **MANY),
    "moving camera, exact": Case(still_lamps, glass(**MOVED), **MANY),
    "focus pull, exact": Case(still_lamps, glass(**PULL), **MANY),
    "focus pull, thick": Case(still_lamps, glass(lens_model="thick", **PULL), **MANY),
    "zoom, thin": Case(
        still_lamps,
        thin(shutter_time=0.04).with_(focal_length=over_time(44.0, 56.0)),
        **MANY,
    ),
    "zoom, projection": Case(
        still_lamps,
        dg.Camera(
            projection=over_time(calibrated(235.0, -2.0), calibrated(299.0, 1.0)),
            f_stop=over_time(2.0, 2.8),
            focus_distance=CLOSE,
            sensor_size=SMALL,
            shutter_time=0.04,
        ),
        **MANY,
    ),
    "zoom, exact": Case(
        still_lamps,
        glass("nikon-ai-25-50mm-f4", 4.0, shutter_time=0.04, zoom=over_time(38.0, 46.0)),
        **MANY,
    ),
}


@pytest.mark.parametrize("name", FAST)
def test_camera_light_and_both_find_one_picture(name: str) -> None:
    check(FAST[name])


@pytest.mark.slow
@pytest.mark.parametrize("name", SLOW)
def test_so_they_do_of_each_alone(name: str) -> None:
    check(SLOW[name])


def punctual() -> dg.Scene:
    """Lights without size over a rough metal and a wall."""
    scene = dg.Scene()
    wall(scene)
    scene.add_light(dg.PointLight((0.4, 0.3, 0.2)), scenes.at(0.1, 0.2, -1.0))
    scene.add_light(dg.SpotLight((0.5, 0.5, 0.9), 5, 30), scenes.at(-0.1, 0.1, -0.9) @ turn(-15, 0))
    ball(scene, dg.Conductor((0.9, 0.8, 0.7), 0.4), (0.0, -0.02, -CLOSE), 0.04)
    return scene


def test_lights_without_size_send_nothing_straight_to_the_lens() -> None:
    """No camera sees them; with bounces they find what the camera's next-event estimation finds."""
    case = Case(punctual, thin(), plan=(2000.0, 0.0), spp=(64, 64, 64), options=TINY)
    alone = pictures(case, "camera")
    assert np.array_equal(pictures(case, "both", seed=-2000), alone)
    bounced = pictures(case, "both", (0.0, 4000.0))
    assert not np.array_equal(bounced, alone)
    assert differences(bounced, by_chance(replace(case, plan=(0.0, 4000.0)), alone)) == []
