"""Four balls in motion, after Cook, Porter and Carpenter's "1984": not two of them move alike.

The 1 rests; the 9 meets the white at 0.25 s and goes another way, and the white starts; the 8 moves
for 14 ms around that time; the 4 starts at 0.256 s. They roll, so their numbers turn. All is made
for `--time 0.25 --shutter 1/24`.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.exporters.gltf import Glb, Track
from extensions.studio import Studio
from kit import shapes, textures
from kit.moves import after, rolling, turn
from kit.pose import Point
from motion.figures import ink

RADIUS = 0.0286
LYING = (-math.sqrt(0.5), 0, 0, math.sqrt(0.5))
COLORS = {
    "1": (0.85, 0.6, 0.03),
    "4": (0.2, 0.04, 0.34),
    "8": (0.015, 0.015, 0.018),
    "9": (0.85, 0.6, 0.03),
}


def make() -> Glb:
    """The scene."""
    studio = Studio("motion.py")
    _table(studio)
    tracks = _balls(studio)
    studio.glb.add_animation("the break", tracks)
    studio.softbox((-0.25, 1.0, -0.1), (0, 0, 0), (0.7, 0.16), 42, (1.0, 0.9, 0.76))
    studio.softbox((0.35, 1.0, -0.1), (0, 0, 0), (0.3, 0.16), 42, (1.0, 0.9, 0.76))
    studio.softbox((0.2, 0.9, 2.2), (0, 0.1, 0), (2.4, 1.2), 0.4, (0.6, 0.75, 1.0))
    studio.camera((0.03, 0.3, 0.42), (-0.005, 0.012, 0), 50, 8, (0, 0.02, 0.04))
    return studio.glb


def _table(studio: Studio) -> None:
    wool = textures.noise((512, 512), (1.2, 1.2), 5) + 0.6 * textures.noise((512, 512), (4, 1), 6)
    color = textures.ramp(np.clip(0.5 + 0.15 * wool, 0, 1), [(0.0, 0.22, 0.12), (0.02, 0.36, 0.22)])
    picture = studio.glb.add_picture("cloth", textures.jpeg(color))
    cloth = studio.matter("cloth", (1, 1, 1), 0.9, pbr={"baseColorTexture": picture})
    studio.put("cloth", shapes.square(3, 3, (0, 0, 12, 12)), cloth, rotation=LYING)


def _skin(number: str, width: int = 512) -> NDArray[np.float64]:
    """A ball's picture: white poles with the number in them, on both sides, and its colour."""
    height = width // 2
    y, x = np.mgrid[0:height, 0:width] + 0.5
    lat, lon = (0.5 - y / height) * math.pi, (x / width) * 2 * math.pi
    point = np.stack([np.cos(lat) * np.cos(lon), np.sin(lat), -np.cos(lat) * np.sin(lon)], -1)
    color = np.broadcast_to(np.array(COLORS[number]), point.shape).copy()
    if int(number) > 8:  # a stripe: white caps
        color[np.abs(point[..., 1]) > 0.56] = (0.88, 0.86, 0.8)
    for side in (-1, 1):
        facing = point[..., 2] * side > 0
        u, v = point[..., 0] * side, point[..., 1]
        color[facing & (np.hypot(u, v) < 0.46)] = (0.88, 0.86, 0.8)
        color[facing & ink(number, u, v, 0.65)] = (0.02, 0.02, 0.02)
    return color


def _balls(studio: Studio) -> list[Track]:
    gloss = {"clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.02}}

    def ball(number: str, at: Point, pose: NDArray[np.float64]) -> int:
        if number == "white":
            matter = studio.matter(number, (0.85, 0.82, 0.74), 0.3, extensions=gloss)
        else:
            picture = studio.glb.add_picture(number, textures.png(_skin(number)))
            matter = studio.matter(
                number, (1, 1, 1), 0.3, pbr={"baseColorTexture": picture}, extensions=gloss
            )
        shape = shapes.ball(RADIUS, 32, 64)
        return studio.put(number, shape, matter, at, rotation=pose.tolist())

    def pose(aside: float, back: float, lean: float = 0) -> NDArray[np.float64]:
        up = after(turn((1, 0, 0), -back), turn((0, 0, 1), lean))
        return after(turn((0, 1, 0), aside), up)

    def moving(
        number: str,
        times: list[float],
        ways: list[tuple[float, float]],
        start: NDArray[np.float64],
        posed: int = 0,
    ) -> list[Track]:
        places = [(x, RADIUS, z) for x, z in ways]
        return rolling(ball(number, places[0], start), times, places, RADIUS, start, posed)

    ball("1", (-0.088, RADIUS, 0.055), pose(20, 38, 12))
    # The 9 meets the white at 0.25 s: it keeps what of its speed runs along the touching faces.
    white, nine = np.array((-0.0185, 0.0905)), np.array((0.0308, 0.0615))
    before, between = np.array((-0.92, -0.38)), (nine - white) / np.linalg.norm(nine - white)
    given = before @ between * between
    path = [nine - 0.1 * before, nine, nine + 0.1 * (before - given)]
    tracks = moving("9", [0.15, 0.25, 0.35], [tuple(p) for p in path], pose(5, 45, -10), 1)
    gone = [tuple(white), tuple(white + 0.02 * given)]
    tracks += moving("white", [0.25, 0.27], gone, pose(0, 0))
    tracks += moving("8", [0.243, 0.257], [(-0.06, -0.028), (-0.05, -0.052)], pose(-15, 15))
    tracks += moving("4", [0.256, 0.40], [(0.075, -0.035), (0.32, -0.16)], pose(10, 30))
    return tracks
