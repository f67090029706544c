"""A fair across the water on a clear night: lamps, a lit wheel, and stars over it.

All of it is 60 m and more away, so that one focus serves the whole picture. Points of light are
what coma, stars of the iris, bloom and halos are seen on.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.exporters.gltf import Glb
from imperfections.glow import BLUE, COOL, GOLD, PINK, RED, TEAL, WARM, WHITE, Glow
from kit import shapes, textures
from kit.pose import Point

AWAY = 60.0  # of the wheel and the booths, m
HUB = (0.0, 1.2)  # of the wheel, from the axis of the camera, m
RADIUS = 9.6  # of the wheel, m
SHORE = -10.4  # height of the water, m
Floats = NDArray[np.float64]


def make() -> Glb:
    """The fair and its camera, 50 mm."""
    glow = Glow()
    rng = np.random.default_rng(8)
    _sky(glow, rng)
    _town(glow, rng)
    _wheel(glow)
    _booths(glow)
    for side in (-1, 1):
        _garland(glow, (9.5 * side, -8.3), (20.6 * side, 9.6), 2.6)
        _garland(glow, (20.6 * side, 9.6), (27.0 * side, -8.3), 1.0)
    glow.camera((0, 0, 0), (0, 0, -AWAY), 50, 8, (0, 0, -AWAY))
    return glow.glb


def _lamp(glow: Glow, x: float, y: float, radius: float, color: Point, luminance: float) -> None:
    """A lamp at the shore, and its long weak image in the water."""
    glow.lamp((x, y, -AWAY), radius, color, luminance)
    below = 2 * SHORE - y
    if below > -16:
        streak = shapes.square(1.6 * radius, 0.6 + 4 * radius)
        glow.show("image", streak, color, min(0.012 * luminance, 0.7), (x, below, -AWAY))


def _sky(glow: Glow, rng: np.random.Generator) -> None:
    """From the last light at the horizon up to the night, and two hundred stars."""
    far = -1500.0
    shades = [(0.09, 0.11, 0.17), (0.10, 0.12, 0.19), (0.13, 0.13, 0.21), (0.17, 0.15, 0.23)]
    shades += [(0.22, 0.17, 0.23), (0.27, 0.19, 0.22)]
    fall = np.linspace(0, 1, 384)[:, None] * np.ones(64)
    fall = np.clip(fall + 0.002 * rng.standard_normal(fall.shape), 0, 1)
    height = 0.36 * -far
    sky = shapes.square(1400, height)
    glow.hang("sky", sky, textures.ramp(fall, shades), (0, height / 2 - 150, far))
    for _ in range(240):
        x, y = rng.uniform(-0.5, 0.5), rng.uniform(-0.02, 0.32)
        color = (WHITE, COOL, GOLD)[rng.integers(3)]
        bright = float(rng.choice([6, 12, 30, 90], p=[0.45, 0.35, 0.15, 0.05]))
        glow.lamp((-x * far, -y * far, far + 10), 0.45, color, bright)


def _town(glow: Glow, rng: np.random.Generator) -> None:
    """Black houses on the far side, a fifth of their windows lit."""
    x = -62.0
    while x < 62:
        wide, high = rng.uniform(5, 11), rng.uniform(3, 9)
        house = shapes.square(wide, high + 10)
        middle = (float(x + wide / 2), float(SHORE - 2.8 + high / 2), -100)
        glow.show("house", house, (0.5, 0.55, 0.9), 0.004, middle)
        for u in np.arange(x + 0.9, x + wide - 0.8, 1.3):
            for v in np.arange(SHORE + 3.2, SHORE + 1.6 + high, 1.5):
                if rng.random() < 0.2:
                    at = (float(u), float(v), -99.9)
                    color = GOLD if rng.random() < 0.8 else COOL
                    glow.show("window", shapes.square(0.5, 0.75), color, 0.5, at)
        x += wide


def _wheel(glow: Glow) -> None:
    """Twenty-four spokes of small lamps, two rims, and a cabin at every second spoke."""
    iron = ((0.6, 0.5, 0.4), 0.02)
    for k in range(24):
        a = 2 * math.pi * k / 24
        x, y = HUB[0] + RADIUS * math.cos(a), HUB[1] + RADIUS * math.sin(a)
        line = np.linspace((*HUB, 0), (x, y, 0), 2)
        glow.show("spoke", shapes.tube(line, 0.035, 4), *iron, at=(0, 0, -AWAY - 0.2))
        for r in np.linspace(0.2, 0.86, 7):
            at = HUB[0] + r * RADIUS * math.cos(a), HUB[1] + r * RADIUS * math.sin(a)
            _lamp(glow, *at, 0.07, WARM, 16)
        if k % 2 == 0:
            color = (RED, TEAL, PINK, BLUE)[k // 2 % 4]
            _lamp(glow, x, y, 0.24, color, 12)
    for r in (0.93, 1.0):
        for k in range(96):
            a = 2 * math.pi * (k + 0.5) / 96
            x, y = HUB[0] + r * RADIUS * math.cos(a), HUB[1] + r * RADIUS * math.sin(a)
            _lamp(glow, x, y, 0.055, GOLD if r < 1 else COOL, 16)
    _lamp(glow, *HUB, 0.5, GOLD, 10)
    for side in (-1, 1):
        leg = np.array([(*HUB, 0), (4.4 * side, SHORE, 0)])
        glow.show("leg", shapes.tube(leg, 0.16, 5), *iron, at=(0, 0, -AWAY - 0.4))


def _booths(glow: Glow) -> None:
    """A row of stalls under striped roofs, and lamps on posts along the water."""
    for k, x in enumerate(np.arange(-25.5, 26, 4.25)):
        color = (RED, TEAL, GOLD, PINK, BLUE)[k % 5]
        at = float(x)
        glow.show("stall", shapes.square(3.2, 1.1), WARM, 0.55, (at, SHORE + 0.75, -AWAY - 1))
        glow.show("image", shapes.square(3.2, 1.4), WARM, 0.02, (at, SHORE - 0.9, -AWAY - 1))
        for stripe in range(8):
            shade = color if stripe % 2 else (0.9, 0.85, 0.75)
            place = (at - 1.575 + 0.45 * stripe, SHORE + 1.62, -AWAY - 0.9)
            glow.show("roof", shapes.square(0.45, 0.62), shade, 0.16, place)
    glow.show("quay", shapes.square(70, 0.3), (0.6, 0.5, 0.45), 0.02, (0, SHORE + 0.1, -AWAY - 1))
    for x in np.arange(-24, 24.1, 6):
        _lamp(glow, float(x), SHORE + 3.3, 0.16, GOLD, 400)
        post = np.array([(x, SHORE + 3.2, 0), (x, SHORE, 0)])
        glow.show("post", shapes.tube(post, 0.05, 4), WARM, 0.01, (0, 0, -AWAY - 0.1))


def _garland(glow: Glow, start: Point, end: Point, sag: float) -> None:
    """Coloured bulbs along a rope that hangs through."""
    s: Floats = np.linspace(0, 1, 22)
    for k, t in enumerate(s[:-1]):
        x = start[0] + t * (end[0] - start[0])
        y = start[1] + t * (end[1] - start[1]) - 4 * sag * t * (1 - t)
        _lamp(glow, float(x), float(y), 0.06, (WARM, TEAL, WARM, PINK, WARM, BLUE)[k % 6], 40)
