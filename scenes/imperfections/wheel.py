"""A wheel of fortune, 60 cm across, 2.2 m away: spokes run outward, rings run around.

Off the axis a lens that has astigmatism makes the one sharp at one focus and the other at another.
The wheel faces the camera and is flat, so nothing but the lens tells its middle from its rim.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.exporters.gltf import Glb, Shape
from imperfections.glow import BLUE, GOLD, RED, WARM, WHITE, Glow
from kit import shapes

AWAY = 2.2  # m
SPOKES = 24
RINGS = (0.07, 0.13, 0.19, 0.25, 0.31)  # radii, m
WIRE = 0.0011  # half its width, m


def make() -> Glb:
    """The wheel and its camera, 100 mm at f/2.2."""
    glow = Glow()
    for k in range(SPOKES):
        color = (RED, (0.9, 0.7, 0.5), BLUE)[k % 3]
        glow.show("field", _ring(RINGS[0], RINGS[-1], k, k + 1), color, 0.07, (0, 0, -AWAY - 0.004))
    for radius in RINGS:
        glow.show("ring", _ring(radius - WIRE, radius + WIRE), GOLD, 1.0, (0, 0, -AWAY - 0.002))
    for k in range(SPOKES):
        glow.show("spoke", _spoke(k), GOLD, 1.0, (0, 0, -AWAY - 0.002))
    for radius in RINGS:
        for k in range(SPOKES):
            angle = 2 * math.pi * k / SPOKES
            at = (radius * math.cos(angle), radius * math.sin(angle), -AWAY)
            glow.lamp(at, 0.0035, WHITE if k % 3 else WARM, 9.0)
    glow.show("hub", shapes.disc(0.03, 48), GOLD, 0.7, (0, 0, -AWAY - 0.001))
    glow.show("booth", shapes.square(1.6, 1.6), (0.5, 0.6, 1.0), 0.012, (0, 0, -AWAY - 0.3))
    glow.camera((0, 0, 0), (0, 0, -AWAY), 100, 2.2, (0, 0, -AWAY))
    return glow.glb


def _ring(inner: float, outer: float, begin: float = 0, end: float = SPOKES) -> Shape:
    """A flat ring, or its part between two spokes, that faces +z."""
    count = 192 if end - begin == SPOKES else 8
    a = np.linspace(begin, end, count + 1) * 2 * math.pi / SPOKES
    rows = [np.stack([r * np.cos(a), r * np.sin(a), 0 * a], 1) for r in (outer, inner)]
    return shapes.surface(np.stack(rows))


def _spoke(k: int) -> Shape:
    """A straight wire from the first ring to the last."""
    a = 2 * math.pi * k / SPOKES
    turn: NDArray[np.float64] = np.array(
        [[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]]
    )
    long = RINGS[-1] - RINGS[0]
    wire = shapes.moved(shapes.square(long, 2 * WIRE), (RINGS[0] + long / 2, 0, 0))
    return shapes.turned(wire, turn)
