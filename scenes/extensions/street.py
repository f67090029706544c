"""A wet street at night: letters of lamps, neon tubes of thousands of triangles, lit posters.

Uses KHR_materials_emissive_strength (with textures), _unlit, KHR_lights_punctual and
EXT_camera_physical.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daguerre.exporters.gltf import Glb
from extensions.houses import add_houses, add_sky
from extensions.letters import written
from extensions.studio import Studio
from kit import shapes, textures
from kit.pose import Point, look, turn_y

RED, AMBER, TEAL = (1.0, 0.1, 0.06), (1.0, 0.5, 0.12), (0.1, 0.9, 0.75)
PINK, BLUE, WARM = (1.0, 0.15, 0.5), (0.15, 0.35, 1.0), (1.0, 0.72, 0.42)
LYING = (-math.sqrt(0.5), 0, 0, math.sqrt(0.5))


def make() -> Glb:
    """The scene."""
    studio = Studio()
    rng = np.random.default_rng(4)
    _ground(studio)
    add_sky(studio)
    for side in (-1, 1):
        add_houses(studio, side, rng)
    _signs(studio)
    _neon(studio)
    _posters(studio)
    _lamps(studio)
    studio.camera((0.35, 1.55, 6.2), (0.0, 2.05, -4), 35, 2, (0, 2, -1.5))
    return studio.glb


def _ground(studio: Studio) -> None:
    wet = textures.noise((256, 256), (7, 7), 6) + 0.4 * textures.noise((256, 256), (1, 1), 7)
    rough = np.clip(0.24 + 0.14 * wet, 0.05, 0.7)
    packed = studio.glb.add_picture("wet", textures.jpeg(textures.metallic_roughness(rough, 0.0)))
    asphalt = studio.matter(
        "asphalt", (0.035, 0.035, 0.04), 1, 1, pbr={"metallicRoughnessTexture": packed}
    )
    ground = shapes.square(16, 60, (0, 0, 4, 15))
    studio.put("ground", ground, asphalt, (0, 0, -20), rotation=LYING)


def _signs(studio: Studio) -> None:
    """Boards of small round lamps that spell a word, hung out from the houses."""
    iron = studio.matter("iron", (0.05, 0.05, 0.055), 0.5)
    for word, color, at, height, upright in [
        ("HOTEL", RED, (-2.2, 2.75, -2.6), 0.5, True),
        ("CAFE", AMBER, (1.95, 2.35, -0.2), 0.42, False),
        ("LENS", TEAL, (2.1, 4.45, -4.5), 0.4, True),
        ("KINO", WARM, (-1.95, 2.25, -6.5), 0.55, False),
        ("F/2", BLUE, (1.45, 2.5, -10), 0.6, False),
        ("BAR", PINK, (-2.0, 4.6, -10.5), 0.6, True),
    ]:
        lamps = written(word, upright)
        rows, columns = lamps.shape[:2]
        glow = studio.glb.add_picture(word, textures.png(lamps[..., None] * np.ones(3)))
        lit = studio.shining(word, color, 16, emissiveTexture=glow)
        unit = height / (11 * 4)
        size = (columns * unit, rows * unit)
        studio.put(word, shapes.square(*size), lit, np.add(at, (0, 0, 0.07)).tolist())
        case = shapes.moved(shapes.box((size[0], size[1], 0.12)), (0, -size[1] / 2, 0))
        studio.put("case", case, iron, at)
        back = np.add(at, (0, 0, -0.07)).tolist()
        studio.put("back", shapes.square(*size), lit, back, rotation=turn_y(180))


def _tube(studio: Studio, name: str, path: Any, color: Point, closed: bool = False) -> None:
    tube = shapes.swept(path, np.full(len(path), 0.018), 12, closed)
    studio.put(name, tube, studio.shining(name, color, 22))


def _neon(studio: Studio) -> None:
    """Some 17,000 emissive triangles: an arrow of rings, a moon, a wave along an eave."""
    t = np.linspace(0, 2 * math.pi, 121)
    for k in range(4):
        ring = [np.cos(t) * (0.16 + 0.09 * k), 0.16 * k + np.sin(t) * (0.16 + 0.09 * k), 0 * t]
        path = np.add(np.stack(ring, 1), (2.3, 1.0, -1.9))
        _tube(studio, "ring", path, (PINK, BLUE, PINK, TEAL)[k], closed=True)
    a = np.linspace(0.7, 5.58, 100)
    horn = np.linspace(5.58, 0.7, 80)
    inner = np.stack([0.17 + 0.28 * np.cos(horn) * 0.95, 0.28 * np.sin(horn) * 0.97], 1)
    moon = np.concatenate([0.4 * np.stack([np.cos(a), np.sin(a)], 1), inner])
    path = np.pad(moon, ((0, 0), (0, 1))) + np.array([-2.1, 4.5, -4.6])
    _tube(studio, "moon", path, WARM)
    s = np.linspace(0, 1, 300)
    for side, color in ((-1, TEAL), (1, RED)):
        wave = [side * (2.66 + 0 * s), 5.0 + 0.08 * np.sin(50 * s), 3 - 18 * s]
        _tube(studio, "wave", np.stack(wave, 1), color)


def _posters(studio: Studio) -> None:
    """Behind lit glass: unlit, so they show as they were drawn."""
    y, x = (np.mgrid[0:96, 0:64] + 0.5) / 64
    sun = np.hypot(x - 0.5, y - 0.6) < 0.3
    stripes = ((y * 14).astype(int) % 2 == 0) & (y > 0.6)
    sky = textures.ramp(y / 1.5, [(0.1, 0.1, 0.4), (0.8, 0.25, 0.4), (1, 0.7, 0.3)])
    art = np.where((sun & ~stripes)[..., None], (1, 0.9, 0.6), sky)
    picture = studio.glb.add_picture("poster", textures.png(art))
    paper = studio.matter(
        "poster", (0.8, 0.8, 0.8), pbr={"baseColorTexture": picture}, extensions={"unlit": {}}
    )
    for side, z in [(-1, 1.6), (1, -3.4), (-1, -8.6)]:
        at = (side * 2.6, 1.25, z)
        studio.put("poster", shapes.square(0.8, 1.2), paper, at, rotation=turn_y(-70 * side))


def _lamps(studio: Studio) -> None:
    """Street lamps: a spot, a glass that shines, a post; and what is left of the moon."""
    lights: list[dict[str, Any]] = [
        {
            "type": "spot",
            "color": list(WARM),
            "intensity": 9.0,
            "spot": {"innerConeAngle": 0.3, "outerConeAngle": 0.95},
        },
        {"type": "directional", "color": [0.5, 0.65, 1.0], "intensity": 0.05},
        {"type": "point", "color": list(AMBER), "intensity": 1.2},
    ]
    studio.glb.json["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
    studio.glb.use("KHR_lights_punctual")

    def light(index: int, at: Point, target: Point) -> None:
        shine = {"KHR_lights_punctual": {"light": index}}
        studio.glb.add_node("light", translation=at, rotation=look(at, target), extensions=shine)

    iron = studio.matter("post", (0.04, 0.05, 0.045), 0.4, 0.6)
    glass = studio.shining("lamp", WARM, 14)
    for side, z in [(-1, 1.6), (1, -3.2), (-1, -8.0), (1, -13)]:
        x = side * 1.95
        studio.put(
            "post", shapes.lathe([(0.05, 0), (0.03, 0.5), (0.025, 3.0)], 16), iron, (x, 0, z)
        )
        studio.put("lamp", shapes.ico_ball(0.11, 2), glass, (x, 3.1, z))
        light(0, (x, 2.95, z), (x * 0.7, 0, z))
    light(1, (-2, 6, 3), (0, 0, -1))
    light(2, (2.3, 2.2, 0.5), (2.3, 0, 0.4))  # in the door of the cafe
