"""A photographer's table at night: an old camera in focus, a garden of small lamps behind it.

A hundred lamps of 2 mm radius hang on five strings, 3 to 8 m from the lens that is focused at
1.2 m: each becomes a disc of light, and toward the corners a cat's eye. Of the camera rays within
such a disc one in a few hundred meets the lamp. A paper lantern beside the photographer lights the
table. Metres, y up; a lamp has 0.04 to 0.6 lm, as the finest fairy lights do, the lantern 62 lm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from daguerre.exporters.gltf import Glb
from kit import shapes, textures
from kit.pose import look, turn_y
from lens_scenes.view_camera import add_view_camera
from night import things
from night.stage import PALETTE, Stage

RADIUS = 0.002  # of a lamp, m
FOCUS = 1.2  # m
EYE_HEIGHT, SUBJECT = 0.170, (0.012, 0.112, 0.010)
STRINGS = (3.1, 4.2, 5.3, 6.5, 7.7)  # m from the lens
LAMPS = 20  # on each


@dataclass(frozen=True)
class Lamp:
    """A small ball of light: where it hangs (m), its colour, and its intensity (cd)."""

    at: tuple[float, float, float]
    color: tuple[float, ...]
    intensity: float

    def luminance(self, radius: float) -> float:
        """In cd/m2, of a ball of this radius that shines as much as any other."""
        return self.intensity / (np.pi * radius**2)


def eye() -> tuple[float, float, float]:
    """The lens, as far from what is sharp as it is focused."""
    x, y, z = SUBJECT
    return x + 0.02, EYE_HEIGHT, z + float(np.sqrt(FOCUS**2 - 0.02**2 - (EYE_HEIGHT - y) ** 2))


def lamps() -> list[Lamp]:
    """All hundred, string by string, over the upper two thirds of the frame and beyond its edge."""
    rng = np.random.default_rng(11)
    hung = []
    for k, away in enumerate(STRINGS):
        s = np.linspace(-1, 1, LAMPS) + rng.uniform(-0.03, 0.03, LAMPS)
        rise = (0.145, 0.095, 0.030, 0.075, -0.010)[k] - 0.065 * np.cos(1.6 * s + k)
        rise += 0.018 * np.sin(7 * s + 2 * k) + rng.uniform(-0.008, 0.008, LAMPS)
        x, y = 0.385 * away * s, EYE_HEIGHT + away * (rise - 0.012)
        z = eye()[2] - away + 0.15 * np.sin(5 * s + k)
        for i in range(LAMPS):
            color = PALETTE[rng.choice(6, p=[0.40, 0.26, 0.14, 0.10, 0.05, 0.05])]
            intensity = float(rng.choice((0.008, 0.012, 0.020))) * (away / 5) ** 2
            hung.append(Lamp((float(x[i]), float(y[i]), float(z[i])), color, intensity))
    return hung


def make() -> Glb:
    """Everything, with glasses on the table and lamps of 80 triangles."""
    stage = Stage("daguerre scenes/lens_scenes.py")
    add_set(stage)
    things.add_glasses(stage)
    for lamp in lamps():
        stage.lamp(lamp.at, RADIUS, lamp.color, round(lamp.luminance(RADIUS)))
    return stage.glb


def add_set(stage: Stage) -> None:
    """Camera, table, garden and lights: all but what is clear, and the lamps."""
    camera = stage.glb.add_camera("Camera", 50.0, 2.0, FOCUS)
    place = {"translation": eye(), "rotation": look(eye(), SUBJECT)}
    stage.glb.add_node("Camera", camera=camera, **place)
    _add_table(stage)
    _add_garden(stage)
    add_view_camera(stage, (0.0, 0.0, -0.05), 24)
    things.add_small_things(stage)
    _add_film(stage)
    stage.lamp([-0.66, 0.66, 0.62], 0.11, (1.0, 0.74, 0.46), 130)


def _add_table(stage: Stage) -> None:
    """Old boards without polish."""
    color, _, _ = textures.wood()
    picture = stage.glb.add_picture("boards", textures.jpeg(color))
    boards = stage.matter("boards", baseColorTexture=picture, roughnessFactor=1.0)
    wide, deep, tile = 2.0, 1.1, 0.72  # the texture repeats every 0.72 m
    top = shapes.box((wide, 0.03, deep), [(0, 0, wide / tile, deep / tile)] * 6)
    stage.put("table", top, boards, translation=[0.05, -0.03, -0.08], rotation=turn_y(-8))


def _add_garden(stage: Stage) -> None:
    """A wall behind the lamps and a lawn, in the light of the moon (0.25 lux) and of the lamps."""
    wall = stage.matter("garden_wall", baseColorFactor=[0.22, 0.20, 0.21, 1], roughnessFactor=1.0)
    stage.put("garden_wall", shapes.box((14, 6, 0.2)), wall, translation=[0, -0.8, -7.6])
    lawn = stage.matter("lawn", baseColorFactor=[0.04, 0.07, 0.03, 1], roughnessFactor=1.0)
    stage.put("lawn", shapes.box((14, 0.05, 12)), lawn, translation=[0, -0.85, -3.0])
    moon = {"type": "directional", "name": "moon", "color": [0.60, 0.75, 1.0], "intensity": 0.25}
    stage.glb.use("KHR_lights_punctual")
    stage.glb.json["extensions"] = {"KHR_lights_punctual": {"lights": [moon]}}
    extensions = {"KHR_lights_punctual": {"light": 0}}
    rotation = look((0, 0, 0), (0.5, -1.0, -1.0))
    stage.glb.add_node("moon", rotation=rotation, extensions=extensions)


def _add_film(stage: Stage) -> None:
    """Cans of film."""
    can = [(0, 0), (0.0155, 0), (0.0155, 0.047), (0.0165, 0.0475), (0.0165, 0.052), (0.015, 0.0525)]
    shape = shapes.lathe([*can, (0.0148, 0.0505), (0, 0.0505)], 64, 40)
    colors = ((0.75, 0.45, 0.04), (0.10, 0.28, 0.12), (0.55, 0.06, 0.04))
    places = ((0.155, 0.045), (0.192, 0.010), (-0.155, 0.02))
    for color, (x, z) in zip(colors, places, strict=True):
        matter = stage.matter("can", baseColorFactor=[*color, 1], roughnessFactor=0.4)
        stage.put("can", shape, matter, translation=[x, 0, z])
    lying = shapes.turned(shape, ((0, -1, 0), (1, 0, 0), (0, 0, 1)))
    steel = stage.matter(
        "tin", baseColorFactor=[0.7, 0.7, 0.72, 1], metallicFactor=1.0, roughnessFactor=0.4
    )
    stage.put("can", lying, steel, translation=[0.285, 0.0165, 0.06], rotation=turn_y(-35))
