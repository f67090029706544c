"""A wheel with wooden spokes, as racing cars had them."""

from __future__ import annotations

import math

import numpy as np

from extensions.studio import Studio
from kit import shapes
from kit.pose import Point

SPOKES, RADIUS = 8, 0.36


def matters(studio: Studio) -> tuple[int, int, int]:
    """Rubber, paint and brass, shared by all wheels."""
    rubber = studio.matter("rubber", (0.025, 0.025, 0.025), 0.7)
    paint = studio.matter("spokes", (0.75, 0.66, 0.42), 0.35)
    brass = studio.matter("hub", (0.9, 0.7, 0.35), 0.25, 1.0)
    return rubber, paint, brass


def add_wheel(studio: Studio, matter: tuple[int, int, int], parent: int, at: Point) -> int:
    """A wheel that turns about z; returns the node that is to turn."""
    glb, (rubber, paint, brass) = studio.glb, matter
    node = glb.add_node("wheel", parent, translation=at)
    angle = np.linspace(0, 2 * math.pi, 97)
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], 1)
    tyre = shapes.swept(ring * (RADIUS - 0.05), np.full(97, 0.05), 20, closed=True)
    rim = shapes.swept(ring * (RADIUS - 0.105), np.full(97, 0.022), 12, closed=True)
    spokes = []
    for k in range(SPOKES):
        a = 2 * math.pi * k / SPOKES
        out = np.array([math.cos(a), math.sin(a), 0])
        spokes.append(shapes.swept(np.outer([0.03, 0.1, 0.26], out), [0.02, 0.017, 0.02], 12))
    hub = shapes.lathe([(0, -0.09), (0.045, -0.08), (0.06, -0.05), (0.06, 0.05)], 32)
    cap = shapes.lathe([(0.06, 0.05), (0.045, 0.08), (0, 0.09)], 32)
    upright = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]  # the axis of a lathe, y, becomes z
    for name, shape, material in [
        ("tyre", tyre, rubber),
        ("rim", rim, paint),
        ("spokes", shapes.join(*spokes), paint),
        ("hub", shapes.turned(shapes.join(hub, cap), upright), brass),
    ]:
        studio.put(name, shape, material, parent=node)
    return node
