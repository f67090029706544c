"""Houses along the street and behind it: fronts with windows, and the sky."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from extensions.studio import Studio
from kit import shapes, textures


def _windows(rng: np.random.Generator) -> NDArray[np.floating]:
    """Five floors of four windows: a few are lit, with curtains half drawn."""
    picture = np.zeros((160, 128, 3))
    for row in range(5):
        for column in range(4):
            if rng.random() < 0.38:
                top, left = 32 * row + 8, 32 * column + 10
                tone = textures.ramp(rng.random((1, 1)), [(1, 0.6, 0.25), (1, 0.85, 0.6)])
                picture[top : top + 18, left : left + 12] = tone
                picture[top : top + rng.integers(1, 9), left : left + 12] *= 0.4
                picture[top : top + 18, left + 6] *= 0.1
    return picture


def add_sky(studio: Studio) -> None:
    """The end of dusk behind the houses."""
    glow = studio.glb.add_picture("dusk", textures.png(textures.night_sky()))
    sky = studio.shining("dusk", (1, 1, 1), 0.5, emissiveTexture=glow)
    studio.put("sky", shapes.square(40, 16), sky, (0, 8, -26))


def add_houses(studio: Studio, side: int, rng: np.random.Generator) -> None:
    """Seven fronts in a row on one side of the street, and the walk before them."""
    for k in range(7):
        picture = studio.glb.add_picture("windows", textures.png(_windows(rng)))
        shade = rng.uniform(0.6, 1.3)
        strength = {"emissive_strength": {"emissiveStrength": 1.2}}
        wall = studio.matter(
            "wall",
            (0.16 * shade, 0.11 * shade, 0.09 * shade),
            0.9,
            emissiveFactor=[1, 1, 1],
            emissiveTexture=picture,
            extensions=strength,
        )
        height, dark = rng.uniform(7, 9.5), (0, 0, 0.01, 0.01)
        front = (0, 0, 1, 1)
        house = shapes.box((3, height, 3.9), [front, front, dark, dark, dark, dark])
        studio.put("house", house, wall, (side * (4.2 + rng.uniform(0, 0.15)), 0, 3 - 4 * k))
        walk = studio.matter("walk", (0.1, 0.1, 0.1), 0.5)
        studio.put("walk", shapes.box((1.2, 0.12, 4)), walk, (side * 2.5, 0, 3 - 4 * k))
