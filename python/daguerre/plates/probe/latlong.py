"""The frame of an environment: rows from the zenith (+y) down, middle column along -z, +x right.

A pixel (x, y) of W x H px, its middle at + 0.5, is at azimuth 2 pi (x / W - 1/2), counted from -z
toward +x, and at polar angle pi y / H, as in ``core/light/environment.cpp``.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.color.spectra import luminance_of_rgb

FloatArray = NDArray[np.float64]


def directions(width: int, height: int, x: FloatArray, y: FloatArray) -> FloatArray:
    """Unit directions of points in px, shape (..., 3)."""
    azimuth, polar = 2 * np.pi * (x / width - 0.5), np.pi * y / height
    flat = np.sin(polar)
    return np.stack([flat * np.sin(azimuth), np.cos(polar), -flat * np.cos(azimuth)], axis=-1)


def centres(width: int, height: int) -> FloatArray:
    """Directions of all pixel centres, shape (H, W, 3)."""
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    return directions(width, height, x, y)


def place(direction: FloatArray, width: int, height: int) -> tuple[float, float]:
    """Point (x, y), px, of a direction, shape (3,)."""
    x, y, z = direction / np.linalg.norm(direction)
    return width * (0.5 + math.atan2(x, -z) / math.tau), height * math.acos(y) / math.pi


def solid_angles(width: int, height: int) -> FloatArray:
    """Solid angle of a pixel of each row, sr, shape (H,); all pixels together are 4 pi."""
    edges = np.cos(np.pi * np.arange(height + 1) / height)
    return np.asarray(-np.diff(edges) * 2 * np.pi / width)


def cosine_weights(width: int, height: int) -> FloatArray:
    """Integral of max(cos polar, 0) over a pixel of each row, sr: illuminance of the ground."""
    edges = np.minimum(np.pi * np.arange(height + 1) / height, np.pi / 2)
    return np.asarray(np.diff(np.sin(edges) ** 2) * np.pi / width)


def luminance(image: NDArray[np.float32]) -> FloatArray:
    """Luminance of pixels, shape (H, W)."""
    return np.asarray(image.astype(np.float64) @ luminance_of_rgb())


def world_from_camera(yaw: float, pitch: float = 0.0) -> FloatArray:
    """Rotation of a camera that looks along -z: up by the pitch, then about +y, degrees.

    The yaw turns as ``--env-rotation`` does: 90 degrees look along -x.
    """
    a, b = math.radians(yaw), math.radians(pitch)
    about_y = [[math.cos(a), 0, math.sin(a)], [0, 1, 0], [-math.sin(a), 0, math.cos(a)]]
    about_x = [[1, 0, 0], [0, math.cos(b), -math.sin(b)], [0, math.sin(b), math.cos(b)]]
    return np.asarray(np.array(about_y) @ np.array(about_x), np.float64)
