"""A monoplane seen from the front; its propeller of three blades turns 24 times a second.

From 0 s to 1 s. In a 48th of a second it makes half a turn.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import Glb, Shape
from extensions.studio import Studio
from kit import shapes, textures
from kit.moves import spinning, turn

TURNS_PER_SECOND, END_S, BLADES = 24, 1.0, 3
SPAN = (0.12, 0.95)  # where a blade begins and ends, m from the axis


def make() -> Glb:
    """The scene."""
    studio = Studio("motion.py")
    _sky(studio)
    _body(studio)
    propeller = add_propeller(studio)
    track = spinning(propeller, (0, 0, 1), TURNS_PER_SECOND, END_S, 17)
    studio.glb.add_animation("the propeller", [track])
    studio.camera((0, 0.06, 6.5), (0, 0.06, 0), 66, 11, (0, 0, 0.7))
    return studio.glb


def _sky(studio: Studio) -> None:
    y = np.linspace(0, 1, 128)[:, None] * np.ones((1, 256))
    cloud = textures.noise((128, 256), (7, 22), 12) + 0.5 * textures.noise((128, 256), (3, 8), 13)
    blue = textures.ramp(y**0.7, [(0.16, 0.36, 0.75), (0.5, 0.7, 0.95), (0.9, 0.92, 0.95)])
    white = np.clip(cloud - 0.35, 0, 1)[..., None] * 0.6
    picture = studio.glb.add_picture("sky", textures.png(blue * (1 - white) + 0.95 * white))
    sky = studio.shining("sky", (1, 1, 1), 0.85, emissiveTexture=picture)
    studio.put("sky", shapes.square(24, 16), sky, (0, 0, -20))
    studio.softbox((4, 6, 8), (0, 0, 0), (3, 3), 14, (1, 0.93, 0.8))
    studio.softbox((-7, 1, 9), (0, 0, 0), (8, 8), 1.0, (0.7, 0.85, 1.0))
    studio.softbox((1, -6, 3), (0, 0, 0), (8, 8), 0.35, (0.5, 0.6, 0.4))


def _body(studio: Studio) -> None:
    """Cowling, fuselage, wings and a wind screen; the nose looks to +z."""
    coat = {"clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.04}}
    red = studio.matter("red", (0.55, 0.02, 0.02), 0.4, extensions=coat)
    cream = studio.matter("cream", (0.8, 0.72, 0.52), 0.4, extensions=coat)
    dark = studio.matter("dark", (0.015, 0.015, 0.018), 0.3)
    steel = studio.matter("steel", (0.6, 0.6, 0.62), 0.3, 1.0)
    forward = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]  # the axis of a lathe, y, becomes z
    hull = [(0.08, -3.2), (0.3, -1.6), (0.44, -0.5), (0.47, 0), (0.44, 0.4), (0.36, 0.52)]
    body = shapes.lathe(shapes.smooth_profile([*hull, (0.3, 0.53), (0.27, 0.46)]), 64, 60)
    studio.put("body", shapes.turned(body, forward), red)
    studio.put("inside", shapes.turned(shapes.lathe([(0.3, 0.4), (0, 0.4)], 48), forward), dark)
    for k in range(9):  # the fins of a radial engine
        a = 2 * math.pi * k / 9
        at = (0.2 * math.cos(a), 0.2 * math.sin(a), 0.42)
        studio.put("cylinder", shapes.ball(0.06, 12, 24), steel, at, scale=(1, 1, 0.5))
    for side in (-1, 1):
        wing = shapes.swept([(0.3 * side, -0.16, -0.5), (4.6 * side, 0.14, -0.6)], [0.6, 0.35], 32)
        wing.positions[:, 1] = (wing.positions[:, 1] + 0.16) * 0.13 - 0.16
        wing.positions[:, 1] += 0.05 * np.abs(wing.positions[:, 0])
        studio.put("wing", shapes.faceted(wing), cream)
        leg = shapes.swept([(0.7 * side, -0.2, 0), (0.8 * side, -0.75, 0.1)], [0.035, 0.03], 12)
        studio.put("leg", leg, steel)
        ring = np.linspace(0, 2 * math.pi, 49)
        path = np.stack([0 * ring + 0.8 * side, 0.17 * np.cos(ring), 0.17 * np.sin(ring)], 1)
        tyre = shapes.swept(np.add(path, (0, -0.8, 0.1)), np.full(49, 0.06), 16, closed=True)
        studio.put("tyre", tyre, dark)
    tail = shapes.box((0.05, 0.8, 0.5))
    studio.put("fin", tail, red, (0, 0.1, -3.0))
    studio.put("elevator", shapes.box((2.4, 0.05, 0.5)), cream, (0, 0.12, -3.0))
    studio.put("screen", shapes.ball(1, 24, 48), dark, (0, 0.42, -0.75), scale=(0.24, 0.22, 0.4))


def blade() -> tuple[Shape, Shape]:
    """One blade along +x, and its painted tip; both sides of a twisted sheet."""

    def part(begin: float, end: float) -> Shape:
        s = np.linspace(begin, end, 40)
        u = (s - SPAN[0]) / (SPAN[1] - SPAN[0])
        chord = 0.055 + 0.13 * np.sin(math.pi * np.clip(u, 0, 1) ** 0.75) ** 0.8
        chord *= np.sqrt(np.clip(1 - u**12, 0, 1))
        pitch = np.radians(62 - 40 * u)
        across = np.linspace(0, 2 * math.pi, 25)  # around an ellipse
        w = 0.5 * chord[:, None] * np.cos(across)
        t = (0.012 + 0.016 * (1 - u))[:, None] * np.sin(across)
        c, n = np.cos(pitch)[:, None], np.sin(pitch)[:, None]
        grid = np.stack(np.broadcast_arrays(s[:, None], w * c - t * n, w * n + t * c), -1)
        return shapes.surface(grid)

    return part(SPAN[0], 0.84), part(0.84, SPAN[1])


def add_propeller(studio: Studio) -> int:
    """Three blades and a spinner before the cowling; returns the node that turns about z."""
    wood = studio.matter("blade", (0.03, 0.03, 0.032), 0.35)
    yellow = studio.matter("tip", (0.9, 0.62, 0.02), 0.4)
    chrome = studio.matter("spinner", (0.85, 0.85, 0.87), 0.08, 1.0)
    node = studio.glb.add_node("propeller", translation=(0, 0, 0.66))
    for name, shape, matter in zip(("blades", "tips"), blade(), (wood, yellow), strict=True):
        mesh = studio.glb.add_mesh(name, shape, matter)
        for k in range(BLADES):
            rotation = turn((0, 0, 1), 360 / BLADES * k)
            studio.glb.add_node(name, node, mesh=mesh, rotation=rotation)
    cone = [(0.17, -0.12), (0.165, 0.0), (0.12, 0.17), (0.04, 0.28), (0, 0.3)]
    forward = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
    nose = shapes.turned(shapes.lathe(shapes.smooth_profile(cone), 48, 60), forward)
    studio.put("spinner", nose, chrome, parent=node)
    return node
