"""A tiled pool full of water, with an amphora and bubbles of air."""

from __future__ import annotations

import numpy as np

from extensions.glass import clear
from extensions.studio import Studio
from kit import shapes, textures
from kit.pose import Point

WATER, GLASS, AIR = 1.333, 1.517, 1.0
#: The camera, at its entrance pupil.
EYE = (0.0, 1.2, 0.0)
#: Distance of the amphora from the entrance pupil, m.
AMPHORA_M = 2.0
TILE_M = 0.25
AMPHORA = [(0, 0), (0.05, 0.01), (0.09, 0.12), (0.2, 0.42), (0.22, 0.6), (0.17, 0.78), (0.075, 0.9)]
AMPHORA += [(0.065, 1.02), (0.09, 1.06), (0.09, 1.08), (0, 1.08)]


def pool() -> Studio:
    """The pool, with a camera that has no housing yet."""
    studio = Studio("solids.py")
    water = clear(studio, "water", WATER, color=(0.2, 0.75, 0.85), distance=9.0)
    studio.put("water", shapes.box((6, 3, 9)), water, (0, -0.1, -3.5))
    _tiles(studio)
    _amphora(studio)
    _bubbles(studio)
    for z in (-1.2, -3.6):
        studio.softbox((0.9, 2.7, z), (0.6, 0, z - 0.2), (2.2, 1.2), 6)
    camera = studio.glb.add_camera("Camera", 35, 5.6, AMPHORA_M)
    studio.glb.add_node("Camera", camera=camera, translation=EYE)
    return studio


def _tiles(studio: Studio) -> None:
    x = (np.arange(128) + 0.5) / 128
    joint = np.minimum(x, 1 - x) < 0.03
    tile = np.where(joint[:, None] | joint, 0.16, 0.72)
    paper = studio.glb.add_picture("tiles", textures.png(np.stack([tile] * 3, -1)))
    tiles = studio.matter("tiles", (0.75, 0.95, 1), 0.4, pbr={"baseColorTexture": paper})
    for name, corner, along, up in (
        ("back", (-2.5, 0, -5), (5, 0, 0), (0, 2.75, 0)),
        ("floor", (-2.5, 0, 0.9), (5, 0, 0), (0, 0, -5.9)),
        ("left", (-2.5, 0, 0.9), (0, 0, -5.9), (0, 2.75, 0)),
        ("right", (2.5, 0, -5), (0, 0, 5.9), (0, 2.75, 0)),
    ):
        studio.put(name, _wall(corner, along, up), tiles)


def _wall(corner: Point, along: Point, up: Point) -> shapes.Shape:
    """A rectangle with whole tiles from its corner."""
    u, v = np.meshgrid((0.0, 1.0), (1.0, 0.0))
    grid = np.asarray(corner) + u[..., None] * np.asarray(along) + v[..., None] * np.asarray(up)
    return shapes.surface(grid, tuple(float(np.linalg.norm(d)) / TILE_M for d in (along, up)))


def _amphora(studio: Studio) -> None:
    clay = studio.matter("clay", (0.62, 0.27, 0.13), 0.6)
    shape = shapes.lathe(shapes.smooth_profile(AMPHORA), 96, 50)
    studio.put("amphora", shape, clay, (0, 0.02, -AMPHORA_M))
    for k, x in enumerate((-1.5, -1.0, 1.0, 1.5)):
        color = ((0.8, 0.12, 0.08), (0.9, 0.7, 0.1), (0.15, 0.5, 0.2), (0.15, 0.2, 0.6))[k]
        studio.put(
            f"ball {k}", shapes.ball(0.18), studio.matter(f"paint {k}", color), (x, 0.18, -2.6)
        )


def _bubbles(studio: Studio) -> None:
    air = clear(studio, "air", AIR)
    random = np.random.default_rng(7)
    for k in range(28):
        height = 0.4 + 2.0 * k / 28
        around = random.normal(0, 0.05 + 0.03 * height, 2)
        radius = 0.008 + 0.012 * random.random() * height
        at = (0.62 + around[0], height, -1.9 + around[1])
        studio.put(
            f"bubble {k}", shapes.ball(radius, 24, 48), air, [round(float(c), 4) for c in at]
        )
