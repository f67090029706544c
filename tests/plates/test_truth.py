"""Objects that are put into the picture of a set, against pictures of the whole scene."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.frame.over import AUTO, DIFFERENCE, FORMS, change_of_rgb
from tests.support.pictures.statistical import differences
from tests.support.scene import scenes

SIZE = (72, 48)
BATCHES, SPP = 8, 48
#: Chance that one case fails though all is right, by pixels, by blocks and by the mean.
ALPHA = 1e-3
MATTE = dg.Diffuse((0.5, 0.4, 0.3))
RED = dg.Diffuse((0.8, 0.15, 0.1))
LENS = "double-gauss-50mm-f2"


def look_at(eye: tuple[float, ...], target: tuple[float, ...]) -> NDArray[np.float64]:
    """World from camera, shape (4, 4)."""
    back = np.subtract(eye, target) / np.linalg.norm(np.subtract(eye, target))
    right = np.cross((0, 1, 0), back)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3] = np.column_stack([right, np.cross(back, right), back, eye])
    return pose


POSE = look_at((0, 1.2, 2.4), (0, 0.4, -1))


def checker(scene: dg.Scene) -> dg.Gltf:
    """A ground of light and dark squares of 15 cm: a blurred plate is not even."""
    squares = np.indices((64, 64)).sum(axis=0) % 2
    pixels = np.where(squares[..., None] > 0, 200, 60).astype(np.uint8).repeat(3, axis=2)
    texture = scene.add_texture(pixels, srgb=True, filter="nearest")
    return dg.Gltf(base_color_texture=dg.TextureSlot(texture), metallic=0.0, roughness=1.0)


def shifted(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> NDArray[np.float64]:
    """World from object."""
    world = np.eye(4)
    world[:3, 3] = x, y, z
    return world


@dataclass(frozen=True)
class Case:
    """A set and an object in it, as one camera sees them."""

    camera: dg.Camera
    ground: Any = None  # None: squares
    material: Any = RED
    place: Any = field(default_factory=lambda: shifted(0, 0.5, -1))
    options: dict[str, Any] = field(default_factory=dict)
    lamps: bool = False  # objects shine, too

    def scene(self, kind: str) -> dg.Scene:
        """The whole scene, the empty set, or the scene with the set marked."""
        scene = dg.Scene()
        corners = np.array([(-5, 0, -8), (-5, 0, 3), (5, 0, 3), (5, 0, -8)], float)
        uv = np.array([(0, 0), (0, 1), (1, 1), (1, 0)], float)
        ground = scene.add_mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]), uv=uv)
        scene.add_instance(ground, self.ground or checker(scene), name="ground")
        if kind != "empty":
            points, triangles, normals = scenes.sphere(24, 0.5)
            ball = scene.add_mesh(points, triangles, normals)
            scene.add_instance(ball, self.material, self.place, name="ball")
        lamp = shifted(1.5, 2.5, 0.5)
        scene.add_light(dg.SphereLight(luminance=(30, 27, 22), radius=0.3), lamp)
        scene.set_environment(color=(0.5, 0.6, 0.8))
        if kind == "caught":
            scene.set_catcher("ground")
        return scene

    def frames(self, kind: str, seed: int) -> list[dg.Frame]:
        """Independent pictures."""
        scene = self.scene(kind)
        return [
            dg.render(
                scene, self.camera, resolution=SIZE, spp=SPP, seed=seed + i, light_paths="off",
                **self.options,
            )
            for i in range(BATCHES)
        ]  # fmt: skip


def thin(**changes: Any) -> dg.Camera:
    """An ideal lens that is focused on the ball."""
    return dg.Camera(POSE, focal_length=35, f_stop=2.8, focus_distance=3.4).with_(**changes)


def real(**changes: Any) -> dg.Camera:
    """A lens of the library, wide open: corners are darker, and colours do not quite meet."""
    base = dg.Camera(POSE, lens=LENS, f_stop=2.0, focus_distance=3.4, sensor_size=(36, 24))
    return base.with_(**changes)


DISTORTED = dg.Projection("opencv", SIZE, (70.0, 70.0), parameters=(-0.3, 0.1, 0.0, 0.0))
GLASS = dg.Material(dg.Dielectric(ior=1.5, alpha=0.0))
GLOSSY = dg.Gltf(base_color=(0.3, 0.25, 0.2), metallic=0.6, roughness=0.25)
PASSING = dg.keys([(-0.02, shifted(-0.4, 0.5, -1)), (0.02, shifted(0.4, 0.5, -1))])

CASES = {
    "matte ground": Case(thin(), MATTE),
    "glossy ground": Case(thin(), GLOSSY),
    "glass": Case(thin(), material=GLASS),
    "lamp": Case(thin(), material=dg.Material(RED, emission=(4, 3, 2))),
    "out of focus, before": Case(thin(f_stop=1.4, focus_distance=7.0)),
    "out of focus, behind": Case(thin(f_stop=1.4, focus_distance=1.8)),
    "motion": Case(thin(shutter_time=0.02), place=PASSING),
    "vignetted corner": Case(real(), place=shifted(-1.0, 1.1, -1)),
    "distorted": Case(dg.Camera(POSE, projection=DISTORTED)),
    "rolling shutter": Case(
        thin(
            shutter_time=0.004,
            shutter_type="electronic",
            rolling_shutter=dg.RollingShutter(readout_time=0.016),
        ),
        place=PASSING,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_the_composite_is_the_picture_of_the_whole(name: str) -> None:
    case = CASES[name]
    whole = np.array([f.rgb for f in case.frames("full", 100)], np.float64)
    plates = [f.rgb for f in case.frames("empty", 200)]
    caught = case.frames("caught", 300)
    # A ratio of two estimates is off by their variance over the samples, which lamps make large.
    for form in (AUTO, DIFFERENCE) if name == "lamp" else FORMS:
        made = [change_of_rgb(f, form).of(p) for f, p in zip(caught, plates, strict=True)]
        assert differences(np.array(made, np.float64), whole, alpha=ALPHA) == [], form
