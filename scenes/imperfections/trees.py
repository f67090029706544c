"""Bare trees against a white sky: the edges on which a lens shows its colours.

Twigs hang into the picture before, in and behind the plane of focus at 3 m.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.io.gltf.writer import Glb, Shape
from imperfections.glow import Glow
from kit import shapes, textures
from kit.pose import Point

FOCUS = 3.0  # m
Floats = NDArray[np.float64]


def make() -> Glb:
    """Three trees before the sky, and their camera, 50 mm."""
    glow = Glow()
    fall = np.linspace(0, 1, 128)[:, None] * np.ones(8)
    sky = textures.ramp(fall, [(0.90, 0.93, 0.97), (0.97, 0.975, 0.98), (0.98, 0.97, 0.95)])
    glow.hang("sky", shapes.square(400, 300), sky, (0, 0, -100))
    rng = np.random.default_rng(12)
    _plant(glow, rng, (-1.35, -1.1, -FOCUS), (0.62, 0.85, 0.0), 0.62, 0.03)
    _plant(glow, rng, (2.1, 0.9, -FOCUS - 0.1), (-1.0, -0.12, 0.02), 0.58, 0.022)
    _plant(glow, rng, (-0.62, 0.62, -1.4), (0.9, -0.5, 0.0), 0.22, 0.007)
    _plant(glow, rng, (0.75, -0.6, -1.5), (-0.6, 0.75, 0.0), 0.2, 0.006)
    for x in (-7.5, -1.5, 4.5, 9.5):
        lean = 0.2 * rng.standard_normal()
        _plant(glow, rng, (x, -6.5, -15 - 0.3 * abs(x)), (lean, 1.0, 0.0), 2.9, 0.15)
    glow.camera((0, 0, 0), (0, 0, -FOCUS), 50, 1.4, (0, 0, -FOCUS))
    return glow.glb


def _plant(
    glow: Glow, rng: np.random.Generator, at: Point, direction: Point, length: float, radius: float
) -> None:
    """A branch and all that grows out of it, black before the sky."""
    wood: list[Shape] = []
    _grow(wood, rng, np.zeros(3), _unit(np.array(direction)), length, radius, 6)
    glow.show("tree", shapes.join(*wood), (0.5, 0.42, 0.36), 0.012, at)


def _grow(wood: list[Shape], rng: np.random.Generator, start: Floats, direction: Floats,
          length: float, radius: float, order: int) -> None:  # fmt: skip
    """A bent piece, twigs along it, and two that go on from its end."""
    bend = 0.35 * length * _unit(rng.standard_normal(3) * (1, 1, 0.3))
    t = np.linspace(0, 1, 7)[:, None]
    path = start + length * direction * t + bend * t * t
    wood.append(shapes.swept(path, radius * np.linspace(1, 0.72, 7), 6))
    if order == 0:
        return
    end = _unit(path[-1] - path[-2])
    for side in (-1, 1):
        onward = _turned(end, side * rng.uniform(0.25, 0.6), rng)
        share = rng.uniform(0.66, 0.86)
        _grow(wood, rng, path[-1], onward, share * length, 0.7 * radius, order - 1)
    if order < 6:
        k = int(rng.integers(2, 5))
        twig = _turned(direction, rng.choice([-1, 1]) * rng.uniform(0.6, 1.1), rng)
        _grow(wood, rng, path[k], twig, 0.55 * length, 0.45 * radius, max(order - 3, 0))


def _turned(direction: Floats, angle: float, rng: np.random.Generator) -> Floats:
    """Turned in the picture's plane, and a little out of it."""
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = direction
    return _unit(np.array([c * x - s * y, s * x + c * y, z + 0.12 * rng.standard_normal()]))


def _unit(v: Floats) -> Floats:
    return np.asarray(v / np.linalg.norm(v))
