"""A ball of glass with a flower of coloured glass and bubbles of air, before stripes."""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import Glb
from extensions.glass import clear
from extensions.studio import Studio
from kit import shapes, textures

RADIUS_M = 0.045


def make() -> Glb:
    """The scene."""
    studio = Studio("solids.py")
    _set(studio)
    glass = clear(studio, "glass", 1.52, color=(0.93, 0.98, 0.96), distance=0.2)
    studio.put("paperweight", shapes.ball(RADIUS_M, 96, 192), glass, (0, RADIUS_M, 0))
    _flower(studio)
    _bubbles(studio)
    studio.softbox((-0.4, 0.6, 0.3), (0, 0.04, 0), (0.4, 0.4), 9)
    studio.softbox((0.5, 0.3, 0.25), (0, 0.04, 0), (0.12, 0.4), 7, (1, 0.94, 0.86))
    studio.camera((0.03, 0.13, 0.42), (0, 0.04, 0), 70, 8, (0, 0.045, 0.02))
    return studio.glb


def _set(studio: Studio) -> None:
    x = (np.arange(512) + 0.5) / 512
    stripe = np.where((x * 20) % 1 < 0.5, 0.9, 0.25) * np.ones((16, 1))
    paper = studio.glb.add_picture("stripes", textures.png(np.stack([stripe] * 3, -1)))
    cloth = studio.matter("stripes", (0.9, 0.85, 0.75), 0.9, pbr={"baseColorTexture": paper})
    studio.backdrop(cloth, 1.2, 0.35, 0.6)


def _flower(studio: Studio) -> None:
    """Petals of red glass around a yellow heart, all inside the clear glass."""
    red = clear(studio, "red glass", 1.65, color=(0.85, 0.05, 0.08), distance=0.006)
    yellow = clear(studio, "yellow glass", 1.7, color=(0.95, 0.7, 0.05), distance=0.006)
    for k in range(7):
        angle = 2 * math.pi * k / 7
        at = [0.015 * math.cos(angle), 0.032, 0.015 * math.sin(angle)]
        studio.put(f"petal {k}", shapes.ball(0.0063, 32, 64), red, at)
    studio.put("heart", shapes.ball(0.0075, 32, 64), yellow, (0, 0.033, 0))


def _bubbles(studio: Studio) -> None:
    air = clear(studio, "air", 1.0)
    for k in range(36):
        angle, height = 2.4 * k, 0.042 + 0.034 * k / 36
        widest = math.sqrt(RADIUS_M**2 - (height - RADIUS_M) ** 2)
        reach = 0.8 * widest * (0.35 + 0.65 * (k * 0.618 % 1))
        at = [reach * math.cos(angle), height, reach * math.sin(angle)]
        radius = 0.0008 + 0.0018 * (k * 0.382 % 1)
        studio.put(f"bubble {k}", shapes.ball(radius, 24, 48), air, [round(c, 5) for c in at])
