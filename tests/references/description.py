"""Scenes in neutral words (numpy only), from which each renderer builds its own.

Metres, +y up. All greys: without colour, a spectral picture and an RGB one are the same picture.
Meshes are flat-shaded triangles, so that both renderers see the same surface to the last facet.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mesh = tuple[Array, NDArray[np.int64]]
Point = tuple[float, float, float]


@dataclass(frozen=True)
class Surface:
    """Material of a mesh: ``value`` is a reflectance, an index or, for a lamp, a luminance."""

    kind: str  # diffuse, conductor, dielectric, lamp
    value: float
    alpha: float = 0.0  # GGX roughness; 0: smooth


@dataclass(frozen=True)
class Lamp:
    """A light that is no mesh: cd, lux or, for a sphere, cd/m2; angles in degrees."""

    kind: str  # point, spot, directional, sphere
    strength: float
    position: Point = (0, 0, 0)
    direction: Point = (0, -1, 0)
    radius: float = 0.0
    inner: float = 0.0
    outer: float = 0.0


@dataclass(frozen=True)
class View:
    """A camera on a 36 x 24 mm film; without an aperture (mm) it is a pinhole."""

    eye: Point
    target: Point
    focal_length: float
    aperture: float | None = None
    focus: float = 1.0  # m along the axis

    def world_from_camera(self) -> Array:
        """The camera looks along -z, +y is up."""
        eye, target = np.array(self.eye, float), np.array(self.target, float)
        z = (eye - target) / np.linalg.norm(eye - target)
        x = np.cross((0, 1, 0), z) / np.linalg.norm(np.cross((0, 1, 0), z))
        out = np.eye(4)
        out[:3, :4] = np.stack([x, np.cross(z, x), z, eye], axis=1)
        return out


@dataclass
class Description:
    """A whole picture to take. ``sky``: luminance of directions (N, 3), or one for all."""

    view: View
    sky: float | Callable[[Array], Array] = 0.0
    parts: list[tuple[Mesh, Surface]] = field(default_factory=list)
    lamps: list[Lamp] = field(default_factory=list)
    size: tuple[int, int] = (48, 32)
    max_depth: int = 8  # surfaces at which a path may scatter


def ball(center: Point, radius: float, segments: int = 24) -> Mesh:
    """A faceted sphere, normals outside."""
    theta, phi = np.meshgrid(
        np.linspace(0, math.pi, segments + 1),
        np.arange(2 * segments) * math.pi / segments,
        indexing="ij",
    )
    unit = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi)], -1)
    i, j = np.meshgrid(np.arange(segments), np.arange(2 * segments), indexing="ij")
    k = (j + 1) % (2 * segments)
    n = 2 * segments
    a, b, c, d = i * n + j, (i + 1) * n + j, (i + 1) * n + k, i * n + k
    # The first row's upper and the last row's lower triangles have no area.
    down, up = np.stack([a, b, c], -1)[:-1], np.stack([a, c, d], -1)[1:]
    faces = np.concatenate([down.reshape(-1, 3), up.reshape(-1, 3)])
    return unit.reshape(-1, 3) * radius + center, faces


def rectangle(center: Point, u: Point, v: Point) -> Mesh:
    """Half edges u and v; the normal is u x v."""
    m, a, b = (np.array(p, float) for p in (center, u, v))
    return np.array([m - a - b, m + a - b, m + a + b, m - a + b]), np.array([(0, 1, 2), (0, 2, 3)])


def floor(half: float = 6.0) -> Mesh:
    """The plane y = 0, facing up."""
    return rectangle((0, 0, 0), (half, 0, 0), (0, 0, -half))


def ring(center: Point, radius: float, height: float, arc: float, segments: int = 48) -> Mesh:
    """A standing strip along an arc (radians) that is open toward +z."""
    phi = np.linspace(-arc / 2, arc / 2, segments + 1)
    x, z = radius * np.sin(phi), -radius * np.cos(phi)
    low = np.stack([x, 0 * x, z], -1) + center
    i = np.arange(segments)
    j = i + segments + 1
    faces = np.concatenate([np.stack([i, i + 1, j + 1], -1), np.stack([i, j + 1, j], -1)])
    return np.concatenate([low, low + np.array((0, height, 0))]), faces
