"""A low sun over the sea: what shines into the lens makes ghosts between its surfaces.

The sun is half a degree across, as it is; sky, water, a boat and a lighthouse shine by themselves.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import Glb
from imperfections.glow import Glow
from kit import shapes, textures
from kit.pose import Point, look

SUN = (-11.0, 4.2)  # to the right and up, degrees
DIAMETER = 0.53  # of the sun, degrees
LUMINANCE = 9000.0  # cd/m2, of which 1 shows as white
COLOR = (1.0, 0.86, 0.66)
AUREOLE = ((1.7, 40.0), (2.6, 3.0))  # of haze: in radii of the sun, cd/m2
FAR = 1000.0  # m
EDGE = 36.0  # of sky and water to each side, degrees
HORIZON = -2.6  # degrees
ASIDE = math.radians(10)  # how far to the right the second camera looks


def make() -> Glb:
    """The sea and its camera, 50 mm."""
    glow = Glow()
    _sky(glow)
    _water(glow)
    _boat(glow, (26.0, 0.0, -150.0))
    _lighthouse(glow)
    right, up = (math.tan(math.radians(a)) * FAR for a in SUN)
    radius = 0.5 * math.radians(DIAMETER) * FAR
    glow.lamp((right, up, -FAR), radius, COLOR, LUMINANCE)
    for behind, (wide, luminance) in enumerate(AUREOLE, 1):
        glow.lamp((right, up, -FAR - behind), wide * radius, COLOR, luminance)
    glow.camera((0, 0, 0), (0, 0, -FAR), 50, 8, (0, 0, -FAR))
    aside = glow.glb.add_camera("aside", 50, 8, FAR)
    turn = look((0, 0, 0), (math.sin(ASIDE), 0, -math.cos(ASIDE)))
    glow.glb.add_node("aside", camera=aside, rotation=turn)
    return glow.glb


def _height(degrees: float, away: float) -> float:
    return math.tan(math.radians(degrees)) * away


def _sky(glow: Glow) -> None:
    """Brighter toward the horizon and around the sun."""
    high, wide = 160, 384
    y, x = np.mgrid[:high, :wide]
    right, up = 2 * EDGE * (x / wide - 0.5), 20.0 - 23.0 * y / high
    near = np.exp(-np.hypot(right - SUN[0], 1.4 * (up - SUN[1])) / 6)
    colors = [(0.20, 0.25, 0.40), (0.38, 0.36, 0.45), (0.62, 0.47, 0.42), (0.78, 0.52, 0.36)]
    sky = textures.ramp(np.clip(y / high, 0, 1), colors) + near[..., None] * (0.26, 0.24, 0.16)
    sky += 0.004 * textures.noise((high, wide), (2, 6), 3)[..., None]
    top, bottom = _height(20, 1.2 * FAR), _height(-3, 1.2 * FAR)
    side = 2 * _height(EDGE, 1.2 * FAR)
    at = (0, 0.5 * (top + bottom), -1.2 * FAR)
    glow.hang("sky", shapes.square(side, top - bottom), sky, at)


def _water(glow: Glow) -> None:
    """Dark waves, and the way of light under the sun."""
    high, wide = 200, 720
    y, x = np.mgrid[:high, :wide]
    depth = (y + 0.5) / high
    waves = textures.noise((high, wide), (1.5, 7), 9) * (0.3 + depth)
    right = 2 * EDGE * (x / wide - 0.5)
    path = np.exp(-(((right - SUN[0]) / (1.4 + 3.5 * depth)) ** 2))
    color = textures.ramp(depth, [(0.42, 0.34, 0.34), (0.19, 0.20, 0.27), (0.10, 0.12, 0.18)])
    color = color * (1 + 0.25 * waves)[..., None]
    glitter = np.clip(waves - 0.2 + 0.4 * (1 - depth), 0, 1.2) * path
    color += glitter[..., None] * (0.75, 0.60, 0.42)
    top, bottom = _height(HORIZON, 0.9 * FAR), _height(-15, 0.9 * FAR)
    side = 2 * _height(EDGE, 0.9 * FAR)
    at = (0, 0.5 * (top + bottom), -0.9 * FAR)
    glow.hang("water", shapes.square(side, top - bottom), color, at)


def _flat(glow: Glow, name: str, outline: list[tuple[float, float]], at: Point,
          shade: float = 0.012) -> None:  # fmt: skip
    """A dark shape that faces the camera; its outline runs counter-clockwise and is convex."""
    points = np.array([(x, 0, -y) for x, y in outline])[:, [0, 2]]
    up = shapes.slab(points, 0.01)
    turn = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    glow.show(name, shapes.turned(up, turn), (0.6, 0.6, 0.8), shade, at)


def _boat(glow: Glow, at: Point) -> None:
    """Hull and two sails."""
    base = (at[0], _height(HORIZON - 0.9, -at[2]), at[2])
    _flat(glow, "hull", [(-5.2, 1.3), (-4.2, 0), (3.8, 0), (5.4, 1.5)], base)
    _flat(glow, "sail", [(0.1, 2.0), (5.0, 2.0), (0.3, 14.0)], base, 0.05)
    _flat(glow, "jib", [(-4.9, 1.9), (-0.3, 2.0), (-0.1, 12.5)], base, 0.07)


def _lighthouse(glow: Glow) -> None:
    """A tower on a rock, at the right."""
    at = (68.0, _height(HORIZON - 0.35, 260.0), -260.0)
    _flat(glow, "rock", [(-22, 0), (24, 0), (14, 4.5), (-9, 4)], at)
    _flat(glow, "tower", [(-2.4, 4), (2.4, 4), (1.5, 24), (-1.5, 24)], at)
    _flat(glow, "lantern", [(-1.1, 24), (1.1, 24), (1.1, 27), (-1.1, 27)], at, 0.05)
    _flat(glow, "roof", [(-1.7, 27), (1.7, 27), (0, 29)], at)
