"""Clear things before a striped wall: cut stones, a prism, a bottle, and a paper lantern.

Uses KHR_materials_transmission, _volume, _ior, _dispersion, _diffuse_transmission,
_emissive_strength and EXT_camera_physical.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daguerre.exporters.gltf import Glb
from extensions.studio import Studio
from kit import shapes, textures
from kit.pose import Point, turn_y

BRILLIANT = [(0, 0), (0.5, 0.43), (0.5, 0.46), (0.42, 0.53), (0.27, 0.6), (0, 0.6)]
OUTSIDE = [(0, 0.003), (0.05, 0), (0.058, 0.012), (0.058, 0.13), (0.04, 0.18), (0.017, 0.21)]
NECK = [(0.017, 0.29), (0.013, 0.29), (0.013, 0.21)]
INSIDE = [(0.036, 0.177), (0.053, 0.128), (0.053, 0.016), (0.045, 0.009), (0, 0.011)]


def make() -> Glb:
    """The scene."""
    studio = Studio()
    _wall(studio)
    _stones(studio)
    _vessels(studio)
    _lantern(studio)
    studio.softbox((-1.1, 1.3, 0.6), (0, 0, 0), (1.3, 1.1), 8, (1, 0.96, 0.9))
    studio.softbox((1.2, 0.7, -0.1), (0, 0.1, 0), (0.5, 1.0), 8, (0.85, 0.93, 1))
    studio.camera((0.06, 0.3, 1.15), (0.02, 0.105, 0), 50, 8, (0, 0.1, 0.06))
    return studio.glb


def clear(studio: Studio, name: str, ior: float, rough: float = 0.0, **more: Any) -> int:
    """Clear matter; `dispersion`, and the `color` that is left of white after `distance` m."""
    volume = {"thicknessFactor": 0.01}
    if "color" in more:
        volume |= {
            "attenuationColor": list(more["color"]),
            "attenuationDistance": more["distance"],
        }
    extensions = {
        "transmission": {"transmissionFactor": 1.0},
        "ior": {"ior": ior},
        "volume": volume,
    }
    if "dispersion" in more:
        extensions["dispersion"] = {"dispersion": more["dispersion"]}
    return studio.matter(name, (1, 1, 1), rough, extensions=extensions)


def _wall(studio: Studio) -> None:
    x = (np.arange(512) + 0.5) / 512
    stripe = np.where((x * 24) % 1 < 0.5, 0.95, 0.06) * np.ones((64, 1))
    paper = studio.glb.add_picture("stripes", textures.png(np.stack([stripe] * 3, -1)))
    wall = studio.matter("stripes", (1, 1, 1), 0.8, pbr={"baseColorTexture": paper})
    studio.put("wall", shapes.square(1.6, 0.5), wall, (0, 0.25, -0.32))
    table = studio.matter("table", (0.22, 0.23, 0.26), 0.35)
    studio.put("table", shapes.box((3, 0.05, 2.4)), table, (0, -0.05, 0.2))
    dark = studio.matter("behind", (0.05, 0.06, 0.08), 0.9)
    studio.put("behind", shapes.square(5, 3), dark, (0, 1, -0.9))


def _stones(studio: Studio) -> None:
    diamond = clear(studio, "diamond", 2.42, dispersion=0.6)
    ruby = clear(studio, "ruby", 1.77, color=(0.75, 0.04, 0.08), distance=0.03, dispersion=0.3)
    flint = clear(studio, "flint", 1.72, dispersion=1.2)
    for name, stone, at, size, turn in [
        ("diamond", diamond, (-0.04, 0, 0.3), 0.13, 12),
        ("ruby", ruby, (0.12, 0, 0.24), 0.1, 40),
    ]:
        cut = shapes.faceted(shapes.lathe(size * np.array(BRILLIANT), 12, 180))
        tilt = math.radians(-38)  # it lies on its girdle and its tip
        tilted = [
            [1, 0, 0],
            [0, math.cos(tilt), -math.sin(tilt)],
            [0, math.sin(tilt), math.cos(tilt)],
        ]
        cut = shapes.standing(shapes.turned(cut, tilted))
        studio.put(name, cut, stone, at, rotation=turn_y(turn))
    triangle = [(0.06 * math.sin(a), -0.06 * math.cos(a)) for a in 2 * math.pi * np.arange(3) / 3]
    prism = shapes.slab(triangle[::-1], 0.16)
    studio.put("prism", prism, flint, (-0.19, 0, 0.06), rotation=turn_y(24))


def _vessels(studio: Studio) -> None:
    green = clear(studio, "bottle glass", 1.52, color=(0.16, 0.6, 0.3), distance=0.012)
    profile = [*shapes.smooth_profile(OUTSIDE, 6).tolist(), *NECK, *INSIDE]
    studio.put("bottle", shapes.lathe(profile, 96, 60), green, (0.05, 0, -0.06))
    amber = clear(studio, "amber", 1.54, color=(0.95, 0.5, 0.08), distance=0.06)
    studio.put("amber", shapes.ball(0.05, 48, 96), amber, (-0.085, 0.05, 0.03))
    frosted = clear(studio, "frosted", 1.45, 0.25, color=(0.6, 0.8, 0.95), distance=0.1)
    cube = shapes.box((0.075, 0.075, 0.075))
    studio.put("frosted", cube, frosted, (-0.29, 0, 0.17), rotation=turn_y(30))


def _lantern(studio: Studio) -> None:
    """A paper ball with ribs around a small bulb: light comes through by diffusion alone."""
    warm: Point = (1.0, 0.62, 0.3)
    through = {
        "diffuseTransmissionFactor": 0.55,
        "diffuseTransmissionColorFactor": [1.0, 0.78, 0.5],
    }
    paper = studio.matter(
        "paper",
        (0.9, 0.85, 0.75),
        0.9,
        doubleSided=True,
        extensions={"diffuse_transmission": through},
    )
    angle = np.linspace(-1.35, 1.35, 145)
    radius = 0.1 * (1 - 0.06 * np.abs(np.cos(12 * angle)))
    profile = np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1)
    studio.put("lantern", shapes.lathe(profile, 96, 60), paper, (0.25, 0.1, 0.02))
    bulb = studio.shining("bulb", warm, 4.5)
    studio.put("bulb", shapes.ico_ball(0.045, 2), bulb, (0.25, 0.1, 0.02))
