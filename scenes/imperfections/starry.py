"""A clear night: stars all over the frame, for coma, which gives them the tails of comets.

All are 200 m away, so that one focus serves them, and no tail of one reaches the next.
"""

from __future__ import annotations

import numpy as np

from daguerre.exporters.gltf import Glb
from imperfections.glow import COOL, GOLD, WARM, WHITE, Glow
from kit import shapes, textures

AWAY = 200.0  # m
FOCAL_LENGTH = 50.0  # mm
APART = 1.25  # from star to star at least, mm on the film
RADIUS = 0.014  # of a star, mm on the film
#: Luminances, cd/m2, and the share of the stars that have them.
LUMINANCES, SHARES = (90.0, 220.0, 520.0), (0.4, 0.35, 0.25)


def make() -> Glb:
    """The stars and their camera, 50 mm at f/2."""
    glow = Glow()
    rng = np.random.default_rng(11)
    shades = [(0.10, 0.12, 0.20), (0.12, 0.15, 0.25), (0.17, 0.19, 0.29)]
    fall = textures.ramp(np.linspace(0, 1, 128)[:, None] * np.ones(8), shades)
    glow.hang("sky", shapes.square(170, 115), fall, (0, 0, -AWAY - 1))
    scale = AWAY / FOCAL_LENGTH
    for x, y in _scattered(rng):
        color = (WHITE, COOL, GOLD, WARM)[rng.integers(4)]
        bright = float(rng.choice(LUMINANCES, p=SHARES))
        glow.lamp((scale * x, scale * y, -AWAY), RADIUS * scale, color, bright)
    glow.camera((0, 0, 0), (0, 0, -AWAY), FOCAL_LENGTH, 2, (0, 0, -AWAY))
    return glow.glb


def _scattered(rng: np.random.Generator) -> list[tuple[float, float]]:
    """Places on the film, mm, thrown one after another where none is too close."""
    found: list[tuple[float, float]] = []
    for x, y in rng.uniform((-18.5, -12.5), (18.5, 12.5), (4000, 2)):
        if all(np.hypot(x - a, y - b) > APART for a, b in found):
            found.append((float(x), float(y)))
    return found
