"""Four exhibits, each packed another way: whole numbers, meshopt twice, and Draco.

Uses KHR_mesh_quantization, EXT_meshopt_compression, KHR_meshopt_compression,
KHR_draco_mesh_compression, KHR_materials_clearcoat, _emissive_strength and EXT_camera_physical.
Making it needs DracoPy, of the extra `compression`.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import Glb, Shape
from extensions.studio import Studio
from kit import packing, shapes
from kit.pose import Point, turn_y


def make() -> Glb:
    """The scene."""
    studio = Studio()
    glb = studio.glb
    studio.backdrop(studio.matter("slate", (0.2, 0.26, 0.32), 0.85), 9, 1.3, 4)
    ceramic = {"clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.02}}
    nacre = studio.matter("nacre", (0.82, 0.66, 0.5), 0.35, extensions=ceramic)
    brass = studio.matter("brass", (0.9, 0.7, 0.34), 0.16, 1.0)
    urchin = studio.matter("urchin", (0.25, 0.07, 0.2), 0.5)
    jade = studio.matter("jade", (0.12, 0.34, 0.22), 0.3, extensions=ceramic)
    stone = studio.matter("stone", (0.62, 0.6, 0.56), 0.8)
    plinth = packing.add_quantized(glb, "plinth", _plinth(), stone)
    places: list[Point] = [(-0.62, 0, 0.05), (-0.2, 0, -0.1), (0.22, 0, 0.02), (0.62, 0, -0.12)]
    exhibits = [
        packing.add_quantized(glb, "shell", _shell(), nacre, "EXT"),
        (packing.add_draco(glb, "knot", _knot(), brass), {}),
        packing.add_quantized(glb, "urchin", _urchin(), urchin, "KHR"),
        packing.add_quantized(glb, "vase", _twisted_vase(), jade),
    ]
    heights = (0.42, 0.62, 0.36, 0.52)
    for k, ((mesh, unpacked), at, height) in enumerate(zip(exhibits, places, heights, strict=True)):
        tall = glb.add_node("stand", translation=at, scale=(1, height, 1), rotation=turn_y(9 * k))
        glb.add_node("plinth", tall, mesh=plinth[0], **plinth[1])
        top = glb.add_node("exhibit", translation=(at[0], height, at[2]), rotation=turn_y(30 * k))
        glb.add_node("mesh", top, mesh=mesh, **unpacked)
    studio.softbox((-1.5, 2.0, 1.3), (0, 0.6, 0), (1.1, 1.1), 11, (1, 0.96, 0.9))
    studio.softbox((1.9, 1.2, 0.4), (0, 0.6, 0), (0.5, 1.4), 8, (0.84, 0.92, 1))
    studio.camera((0.0, 0.85, 2.7), (0, 0.6, 0), 58, 5.6, (0, 0.6, 0.1))
    return glb


def _plinth() -> Shape:
    """A column one metre tall, so that its node's scale is its height."""
    return shapes.box((0.26, 1, 0.26))


def _shell() -> Shape:
    """A spiral that grows by the same share with each turn, as a snail's does."""
    turn, ring = np.linspace(-24, 0, 420), np.linspace(0, 2 * math.pi, 49)
    grow = np.exp(0.115 * turn)[:, None]
    ribs = 1 + 0.05 * np.cos(9 * turn)[:, None]
    out = grow * (0.62 + 0.4 * ribs * np.cos(ring))
    up = grow * (1.35 - 0.48 * ribs * np.sin(ring)) * 1.1
    x, z = out * np.cos(turn)[:, None], out * np.sin(turn)[:, None]
    grid = 0.11 * np.stack([x, up[0, 0] + 2.0 - up, z], -1)
    return shapes.standing(shapes.surface(grid))


def _knot() -> Shape:
    """A torus knot, twice around and three times through."""
    t = np.linspace(0, 2 * math.pi, 401)
    r = 0.105 + 0.045 * np.cos(3 * t)
    path = np.stack([r * np.cos(2 * t), r * np.sin(2 * t), 0.055 * np.sin(3 * t)], 1)
    return shapes.standing(shapes.swept(path, np.full(len(t), 0.024), 32, closed=True))


def _urchin() -> Shape:
    """A ball of bumps in rows."""
    v, u = np.meshgrid(
        np.linspace(0, math.pi, 181), np.linspace(0, 2 * math.pi, 301), indexing="ij"
    )
    bumps = np.maximum(np.sin(20 * u) * np.sin(22 * v), 0) ** 1.5 * np.sin(v)
    r = 0.12 * (1 + 0.22 * bumps)
    flat = np.stack([np.sin(v) * np.cos(u), 0.72 * np.cos(v), -np.sin(v) * np.sin(u)], -1)
    return shapes.standing(shapes.surface(flat[::-1] * r[::-1, :, None]))


def _twisted_vase() -> Shape:
    """Fluted, each ring turned a little against the one below."""
    profile = shapes.smooth_profile(
        [(0.05, 0), (0.085, 0.06), (0.1, 0.14), (0.07, 0.22), (0.045, 0.27), (0.07, 0.31)], 12
    )
    inner = profile[::-1] * [0.9, 1]
    wall = np.concatenate([profile, inner[:-8]])
    angle = np.linspace(0, 2 * math.pi, 193)
    r = wall[:, :1] * (1 + 0.07 * np.cos(10 * angle + 12 * wall[:, 1:]))
    grid = np.stack([r * np.cos(angle), wall[:, 1:] + 0 * r, -r * np.sin(angle)], -1)
    return shapes.surface(grid)
