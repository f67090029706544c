"""Newton's cradle: chrome balls on strings over a lacquered board; the outer two take turns.

It repeats after a period of 0.75 s. At 0.15 s the left one comes down, at 0.7 m/s.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import Glb, Track
from extensions.studio import Studio
from kit import shapes, textures
from kit.moves import turn

BALLS, RADIUS, DROP, HEIGHT = 5, 0.025, 0.14, 0.19
PERIOD_S = 2 * math.pi * math.sqrt(DROP / 9.81)
REACH_DEG = 36.0
LYING = (-math.sqrt(0.5), 0, 0, math.sqrt(0.5))


def make() -> Glb:
    """The scene."""
    studio = Studio("motion.py")
    _board(studio)
    _frame(studio)
    studio.glb.add_animation("swing", _balls(studio))
    studio.softbox((0.3, 0.8, -0.5), (0, 0.05, 0), (0.3, 0.3), 34, (1.0, 0.95, 0.88))
    studio.softbox((-1.1, 0.5, 0.6), (0, 0.1, 0), (0.5, 1.2), 1.2, (0.75, 0.87, 1.0))
    studio.softbox((-0.1, 0.75, 1.9), (0, 0.1, 0), (3.5, 0.8), 0.9)
    studio.camera((0.12, 0.16, 0.62), (-0.02, 0.082, 0), 50, 8, (0, 0.05, 0))
    return studio.glb


def _board(studio: Studio) -> None:
    size = 512
    y, x = np.mgrid[0:size, 0:size] // (size // 8)
    check = ((x + y) % 2)[..., None]
    color = np.where(check, (0.78, 0.72, 0.6), (0.55, 0.5, 0.42))
    picture = studio.glb.add_picture("check", textures.png(color))
    gloss = {"clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.03}}
    board = studio.matter(
        "board", (1, 1, 1), 0.5, pbr={"baseColorTexture": picture}, extensions=gloss
    )
    studio.put("board", shapes.square(2.4, 2.4, (0, 0, 6, 6)), board, rotation=LYING)
    wall = studio.matter("wall", (0.5, 0.2, 0.1), 0.9)
    studio.put("wall", shapes.square(5, 3), wall, (0, 1.5, -1.2))


def _frame(studio: Studio) -> None:
    steel = studio.matter("rod", (0.75, 0.75, 0.77), 0.12, 1.0)
    for z in (-0.07, 0.07):
        bend = np.linspace(0, math.pi / 2, 9)
        corner = 0.03 * np.stack([1 - np.cos(bend), np.sin(bend) - 1], 1) + (-0.15, HEIGHT)
        half = np.concatenate([[(-0.15, 0)], corner])
        arch = np.concatenate([half, half[::-1] * (-1, 1)])
        path = np.append(arch, np.full((len(arch), 1), z), 1)
        studio.put("arch", shapes.swept(path, np.full(len(path), 0.004), 16), steel)


def _balls(studio: Studio) -> list[Track]:
    glb = studio.glb
    chrome = studio.matter("chrome", (0.86, 0.86, 0.88), 0.03, 1.0)
    thread = studio.matter("thread", (0.6, 0.6, 0.55), 0.7)
    ball = glb.add_mesh("ball", shapes.ball(RADIUS, 48, 96), chrome)
    two = [
        shapes.tube([(0, -DROP + RADIUS, 0), (0, -DROP / 2, z / 2), (0, 0, z)], 0.0006, 6)
        for z in (-0.07, 0.07)
    ]
    threads = glb.add_mesh("threads", shapes.join(*two), thread)
    pivots = []
    for k in range(BALLS):
        x = (k - (BALLS - 1) / 2) * 2.002 * RADIUS
        pivot = glb.add_node("pivot", translation=(x, HEIGHT, 0))
        glb.add_node("ball", pivot, mesh=ball, translation=(0, -DROP, 0))
        glb.add_node("threads", pivot, mesh=threads)
        pivots.append(pivot)
    times = np.linspace(0, PERIOD_S, 97)
    swing = REACH_DEG * np.cos(2 * math.pi * times / PERIOD_S)
    left, right = -np.maximum(swing, 0), np.maximum(-swing, 0)
    return [
        Track({"node": n, "path": "rotation"}, times, [turn((0, 0, 1), a) for a in angles])
        for n, angles in ((pivots[0], left), (pivots[-1], right))
    ]
