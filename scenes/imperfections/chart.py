"""A flat test chart, 1.8 m wide, 2.2 m away: stars of spokes, as Siemens drew them, and points.

Spokes of a blurred star run into each other: the grey ball in its middle is as large as the blur.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import Glb, Shape
from imperfections.glow import COOL, GOLD, WARM, WHITE, Glow
from kit import shapes

AWAY = 2.2  # m
STEP, ACROSS, DOWN = 0.15, 13, 9  # from star to star, m, and how many there are
RADIUS, SPOKES = 0.062, 18  # of a star, m


def make() -> Glb:
    """The chart and its camera, 50 mm at f/2."""
    glow = Glow()
    star = _star()
    for i in range(ACROSS):
        for j in range(DOWN):
            x, y = STEP * (i - ACROSS // 2), STEP * (j - DOWN // 2)
            color = (WHITE, GOLD, COOL)[(i + 2 * j) % 3]
            glow.show("star", shapes.moved(star, (x, y, 0)), color, 0.8, (0, 0, -AWAY))
            for k in (-1, 1):
                glow.lamp((x + k * STEP / 4, y + STEP / 2, -AWAY), 0.0016, WARM, 12.0)
    glow.show("board", shapes.square(4, 3), COOL, 0.02, (0, 0, -AWAY - 0.01))
    glow.camera((0, 0, 0), (0, 0, -AWAY), 50, 2, (0, 0, -AWAY))
    return glow.glb


def _star() -> Shape:
    """Wedges from the middle outward that face +z, as wide as the gaps between them."""
    wedges = []
    for k in range(SPOKES):
        a = np.linspace(k, k + 0.5, 4) * 2 * math.pi / SPOKES
        rim = np.stack([RADIUS * np.cos(a), RADIUS * np.sin(a), 0 * a], 1)
        wedges.append(shapes.surface(np.stack([rim, 0.02 * rim])))
    return shapes.join(*wedges)
