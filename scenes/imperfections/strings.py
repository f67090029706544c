"""Strings of lamps far behind the focus and close before it, and a sign that is in focus.

A lens that has spherical aberration draws discs of light with a bright rim on one side of the focus
and with a bright middle on the other; what is in focus has a veil around it.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.io.gltf.writer import Glb
from extensions.letters import written
from imperfections.glow import COOL, GOLD, PINK, TEAL, WARM, Glow
from kit import shapes, textures

FOCUS = 1.6  # of the sign, m
NEAR, FAR = 0.62, 40.0  # of the lamps, m
FOCAL_LENGTH = 50.0  # mm


def make() -> Glb:
    """The strings, the sign and their camera, 50 mm."""
    glow = Glow()
    _backdrop(glow)
    _sign(glow)
    _strings(glow)
    glow.camera((0, 0, 0), (0, 0, -FOCUS), FOCAL_LENGTH, 1.5, (0, 0, -FOCUS))
    return glow.glb


def _backdrop(glow: Glow) -> None:
    """A dusky wall far away, darker toward its top."""
    fall = np.linspace(0, 1, 192)[:, None] * np.ones(16)
    shades = [(0.05, 0.06, 0.11), (0.10, 0.09, 0.14), (0.15, 0.11, 0.12), (0.07, 0.055, 0.06)]
    glow.hang("dusk", shapes.square(120, 80), textures.ramp(fall, shades), (0, 0, -90))


def _sign(glow: Glow) -> None:
    """A board of small round lamps in the plane of focus."""
    lamps = written("CAFE")
    rows, columns = lamps.shape
    high = 0.085
    wide = high * columns / rows
    glow.show("board", shapes.square(wide, high), COOL, 0.004, (0, -0.01, -FOCUS - 0.003))
    dots = lamps.reshape(rows // 8, 8, columns // 8, 8).max(axis=(1, 3))
    step = high / len(dots)
    for row, column in np.argwhere(dots > 0):
        x, y = (column + 0.5) * step - wide / 2, high / 2 - 0.01 - (row + 0.5) * step
        glow.lamp((float(x), float(y), -FOCUS), 0.34 * step, GOLD, 1.6)


def _strings(glow: Glow) -> None:
    """Three rows far behind the focus, above, and two before it, below; all look equally large."""
    for depth, rows, luminance in ((FAR, (5.1, 3.7, 2.3), 14.0), (NEAR, (-3.0, -5.0), 38.0)):
        for row, high in enumerate(rows):
            for k in range(-4, 5):
                x = 2.15 * (k + 0.5 * (row % 2)) + 0.2 * math.sin(5.0 * k + row)
                y = high + 0.25 * math.cos(2.2 * k + 3.0 * row)
                color = (WARM, GOLD, TEAL, WARM, COOL, PINK)[(k + 3 * row) % 6]
                scale = depth / FOCAL_LENGTH
                glow.lamp((scale * x, scale * y, -depth), 0.075 * scale, color, luminance)
