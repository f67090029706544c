"""Three pinwheels before a fence, near, farther and far; they turn twice a second, from 0 s to 2 s.

There is no light in it: give it a sky, such as `--sky 57,60,69` (cd/m2, some time after sunset).
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import Glb, Shape
from extensions.studio import Studio
from kit import shapes, textures
from kit.moves import spinning
from kit.pose import Point

TURNS_PER_SECOND, END_S, SAILS = 2, 2.0, 6
RADIUS = 0.15  # of a pinwheel, m
COLOURS = ((0.75, 0.04, 0.03), (0.9, 0.55, 0.03), (0.03, 0.16, 0.55), (0.85, 0.83, 0.78))
#: Where the hubs are, m; and the colours of the sails in turn.
WHEELS = (
    ((-0.30, 1.08, -1.0), (0, 3)),
    ((0.16, 1.16, -2.0), (1, 2)),
    ((0.95, 1.05, -3.9), (2, 3)),
)


def make() -> Glb:
    """The scene."""
    studio = Studio("exposure.py")
    colours = [studio.matter(f"sail {k}", c, 0.5, doubleSided=True) for k, c in enumerate(COLOURS)]
    stick = studio.matter("stick", (0.55, 0.38, 0.2), 0.6)
    hub = studio.matter("hub", (0.8, 0.62, 0.2), 0.25, 1.0)
    tracks = []
    for k, (at, pair) in enumerate(WHEELS):
        wheel = _wheel(studio, k, at, [colours[c] for c in pair], hub)
        sense = -1 if k % 2 else 1
        tracks.append(spinning(wheel, (0, 0, sense), TURNS_PER_SECOND, END_S, 25))
        x, y, z = at
        pole = shapes.tube([(x, 0, z - 0.03), (x, y, z - 0.03)], 0.008, 12)
        studio.put("stick", pole, stick)
    studio.glb.add_animation("the wind", tracks)
    _garden(studio)
    studio.camera((0, 1.12, 0), (0.02, 1.06, -2), 50, 4, (0.16, 1.16, -2.0))
    return studio.glb


def _wheel(studio: Studio, index: int, at: Point, colours: list[int], hub: int) -> int:
    node = studio.glb.add_node(f"pinwheel {index}", translation=at)
    for k in range(SAILS):
        mesh = studio.glb.add_mesh(
            f"sail {index} {k}", sail(2 * math.pi * k / SAILS), colours[k % 2]
        )
        studio.glb.add_node(f"sail {index} {k}", node, mesh=mesh)
    studio.put("hub", shapes.ball(0.014, 12, 24), hub, (0, 0, 0.02), parent=node)
    return node


def sail(turned: float) -> Shape:
    """A sheet of paper from the hub, one edge bent to the front and back to the hub."""
    r, t = np.linspace(0.02, 1, 24)[:, None], np.linspace(0, 1, 16)[None]
    angle = turned + 0.15 + t * 2 * math.pi / SAILS * 0.95
    reach = RADIUS * r * (1 - 0.28 * t)
    bulge = 0.30 * RADIUS * np.sin(math.pi * r) * t**1.5
    grid = np.stack([reach * np.cos(angle), reach * np.sin(angle), bulge], -1)
    return shapes.surface(grid)


def _garden(studio: Studio) -> None:
    boards = textures.wood(512, 8)[0]
    fence = studio.glb.add_picture(
        "fence", textures.jpeg(np.clip(2.2 * boards * (0.75, 0.8, 0.85), 0, 1))
    )
    wood = studio.matter("fence", (1, 1, 1), 0.8, pbr={"baseColorTexture": fence})
    pointed = [(0, 1.15), (0.11, 1.3), (0.22, 1.15), (0.22, 0), (0, 0)]
    upright = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]  # a slab lies on the ground
    pale = shapes.turned(shapes.slab(pointed, 0.03), upright)
    for k in range(22):
        studio.put("pale", pale, wood, (-3.0 + 0.28 * k, 0, -4.6))
    for y in (0.35, 0.95):
        studio.put("rail", shapes.box((6.4, 0.09, 0.04)), wood, (0, y, -4.66))
    blades = textures.noise((256, 256), (2, 9), 5) + 0.4 * textures.noise((256, 256), (6, 6), 6)
    shades = [(0.02, 0.05, 0.015), (0.10, 0.19, 0.05), (0.2, 0.3, 0.09)]
    greens = textures.ramp(0.5 + 0.25 * blades, shades)
    grass = studio.glb.add_picture("grass", textures.jpeg(np.clip(greens, 0, 1)))
    lawn = studio.matter("lawn", (1, 1, 1), 0.9, pbr={"baseColorTexture": grass})
    ground = shapes.square(14, 14, (0, 0, 8, 8))
    studio.put("lawn", ground, lawn, (0, 0, -5), rotation=(-math.sqrt(0.5), 0, 0, math.sqrt(0.5)))
    leaves = textures.noise((256, 512), (4, 4), 8) + textures.noise((256, 512), (12, 12), 9)
    shades = [(0.01, 0.025, 0.012), (0.05, 0.10, 0.03), (0.13, 0.2, 0.05)]
    greens = textures.ramp(0.5 + 0.2 * leaves, shades)
    hedge = studio.glb.add_picture("hedge", textures.jpeg(np.clip(greens, 0, 1)))
    green = studio.matter("hedge", (1, 1, 1), 0.9, pbr={"baseColorTexture": hedge})
    studio.put("hedge", shapes.square(16, 2.6, (0, 0, 3, 1)), green, (0, 1.3, -7))
