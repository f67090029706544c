"""Skies by script, the same at any size: panoramas (W / 2, W, 3), linear Rec.709, cd/m2."""

from __future__ import annotations

import numpy as np

Direction = tuple[float, float, float]
#: Diameter of the sun, degrees, and its illuminance across its own direction, lux.
SUN_DEG, SUN_LUX = 0.5, 40.0
GROUND = np.array((0.32, 0.30, 0.26))


def overcast(width: int) -> np.ndarray:
    """The CIE's overcast sky, 3 cd/m2 at the zenith, with soft clouds."""
    way = directions(width)
    up = np.clip(way[..., 1], 0, 1)
    light = (1 + 2 * up) * (1 + 0.25 * clouds(way))
    return _above_ground(way, light[..., None] * (0.95, 1.0, 1.06))


def sunny(width: int, toward: Direction) -> np.ndarray:
    """A blue sky with a sun, which fills no less than one texel.

    Args:
        width: Texels around the horizon, an even number.
        toward: Direction of the sun.
    """
    way = directions(width)
    up = np.clip(way[..., 1], 0, 1)[..., None]
    haze = (1 - up) ** 3
    sky = (0.55, 0.75, 1.15) * (1 - haze) + np.array((1.5, 1.45, 1.35)) * haze
    picture = _above_ground(way, sky * (1 + 0.4 * np.clip(clouds(way), 0, 1)[..., None]))
    sun = np.divide(toward, np.linalg.norm(toward))
    texel = 180 / (width // 2)
    disc = way @ sun >= np.cos(np.radians(max(SUN_DEG / 2, 0.75 * texel)))
    sine = np.sqrt(1 - way[..., 1] ** 2)
    steradians = float(sine[disc].sum()) * np.radians(texel) ** 2
    picture[disc] = np.array((1.08, 1.0, 0.88)) * SUN_LUX / steradians
    return picture


def directions(width: int) -> np.ndarray:
    """Unit directions of the texels: row 0 at +y, the middle column at -z."""
    height = width // 2
    theta = (np.pi * (np.arange(height) + 0.5) / height)[:, None]
    phi = (2 * np.pi * ((np.arange(width) + 0.5) / width - 0.5))[None, :]
    parts = (np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi))
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


def clouds(way: np.ndarray) -> np.ndarray:
    """Smooth waves of directions, from -1 to 1."""
    rng = np.random.default_rng(7)
    way = way.astype(np.float32)
    total = np.zeros(way.shape[:-1], np.float32)
    for octave in range(4):
        axes = np.float32(rng.normal(size=(3, 3)) * 3.0 * 2**octave)
        phases = np.float32(rng.uniform(0, 2 * np.pi, 3))
        for axis, phase in zip(axes, phases, strict=True):
            total += np.sin(way @ axis + phase) / np.float32(3 * 1.6**octave)
    return np.clip(total, -1, 1)


def _above_ground(way: np.ndarray, sky: np.ndarray) -> np.ndarray:
    return np.where(way[..., 1:2] > 0, sky, GROUND).astype(np.float32)
