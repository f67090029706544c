"""Strings of lamps far behind the focus and close before it, and a sign that is in focus.

A lens that has spherical aberration draws discs of light with a bright rim on one side of the focus
and with a bright middle on the other; what is in focus has a veil around it. All of it fills a
frame of 18 x 12 mm behind a lens of 90 mm.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import Glb
from extensions.letters import written
from imperfections.glow import COOL, GOLD, PINK, TEAL, WARM, Glow
from kit import shapes, textures

FOCUS = 1.6  # of the sign, m
FOCAL_LENGTH = 90.0  # mm
#: Strings: their distance, m; height on the film, mm; luminance of the lamps, cd/m2.
STRINGS = ((40.0, 4.2, 50.0), (0.42, -4.2, 55.0))
STEP, RADIUS = 3.0, 0.07  # from lamp to lamp, and of a lamp, mm on the film


def make() -> Glb:
    """The strings, the sign and their camera."""
    glow = Glow()
    _backdrop(glow)
    _sign(glow)
    _strings(glow)
    glow.camera((0, 0, 0), (0, 0, -FOCUS), FOCAL_LENGTH, 4.8, (0, 0, -FOCUS))
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
    high = 0.072
    wide = high * columns / rows
    glow.show("board", shapes.square(wide, high), COOL, 0.004, (0, 0, -FOCUS - 0.003))
    dots = lamps.reshape(rows // 8, 8, columns // 8, 8).max(axis=(1, 3))
    step = high / len(dots)
    for row, column in np.argwhere(dots > 0):
        x, y = (column + 0.5) * step - wide / 2, high / 2 - (row + 0.5) * step
        glow.lamp((float(x), float(y), -FOCUS), 0.3 * step, GOLD, 2.4)


def _strings(glow: Glow) -> None:
    """A string far behind the focus, above, and one before it, below; both look equally large."""
    for away, high, luminance in STRINGS:
        scale = away / FOCAL_LENGTH
        for k in range(-3, 4):
            y = high + 0.25 * math.cos(2.2 * k)
            color = (WARM, TEAL, GOLD, PINK, COOL)[k % 5]
            glow.lamp((scale * STEP * k, scale * y, -away), RADIUS * scale, color, luminance)
