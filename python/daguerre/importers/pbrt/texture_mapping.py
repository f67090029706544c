"""Mappings of textures: from a surface to coordinates s, t with the origin at the lower left.

Source: pbrt-v4's user's guide ("Textures"); Pharr, Jakob and Humphreys 2023, section 10.2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .state import Entity
from .transforms import Matrix, inverse

Array = NDArray[np.float64]
Six = tuple[float, float, float, float, float, float]
KINDS = ("uv", "spherical", "cylindrical", "planar")


@dataclass(frozen=True)
class UvMapping:
    """s = ``scale[0]`` u + ``offset[0]``, and t of v likewise."""

    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)

    def at(self, u: Array, v: Array) -> tuple[Array, Array]:
        """Coordinates s, t at texture coordinates."""
        return self.scale[0] * u + self.offset[0], self.scale[1] * v + self.offset[1]

    def transform(self, period: float) -> Six:
        """Transform from texture coordinates of a mesh (v downward) to coordinates of a picture.

        Args:
            period: Size of the picture in s and t.
        """
        (su, sv), (du, dv) = self.scale, self.offset
        return (su / period, 0.0, du / period, 0.0, sv / period, 1.0 - (sv + dv) / period)

    @property
    def repeats(self) -> bool:
        """Whether a pattern that repeats in s, t repeats in u, v."""
        return all(scale == round(scale) != 0 for scale in self.scale)


@dataclass(frozen=True, eq=False)
class SpaceMapping:
    """Mapping by the place in the world: spherical, cylindrical or planar.

    Attributes:
        kind: One of ``KINDS``, besides ``uv``.
        from_world: Texture space from world, shape (4, 4).
        axes: Vectors of s and t of a plane, shape (2, 3).
        offset: Offsets of s and t of a plane.
        on_sphere: Whether t on a cylinder is the height on the unit sphere, as in pbrt-v3.
    """

    kind: str
    from_world: Matrix
    axes: Array
    offset: tuple[float, float]
    on_sphere: bool = False

    def coordinates(self, world: Array) -> Array:
        """Coordinates s, t of points of the world, shape (N, 2)."""
        points = world @ self.from_world[:3, :3].T + self.from_world[:3, 3]
        if self.kind == "planar":
            return points @ self.axes.T + self.offset
        around = np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi)
        lengths = np.linalg.norm(points, axis=1)
        height = points[:, 2] / np.where(lengths > 0, lengths, 1)
        if self.kind == "cylindrical":
            return np.stack([around + 0.5, height if self.on_sphere else points[:, 2]], axis=1)
        down = np.arccos(np.clip(height, -1, 1)) / np.pi
        return np.stack([down, np.mod(around, 1.0)], axis=1)


Mapping = UvMapping | SpaceMapping


def mapping_of(entity: Entity, version: int) -> Mapping:
    """Reads the mapping of a texture; planes of pbrt-v3 are in the world.

    Raises:
        InputError: The mapping is unknown, or a parameter is wrong.
    """
    parameters = entity.parameters
    kind = parameters.text("mapping", "uv")
    if kind not in KINDS:
        entity.place.fail(f"mapping: wanted {', '.join(KINDS)}, got {kind[:40]!r}")
    number = parameters.number
    offset = number("udelta", 0.0), number("vdelta", 0.0)
    if kind == "uv":
        return UvMapping((number("uscale", 1.0), number("vscale", 1.0)), offset)
    axes = np.zeros((2, 3))
    from_world = inverse(entity.state.transform.start, entity.place)
    if kind == "planar":
        axes = np.stack([parameters.point("v1", (1, 0, 0)), parameters.point("v2", (0, 1, 0))])
        from_world = np.eye(4) if version == 3 else from_world
    else:
        offset = (0.0, 0.0)
    return SpaceMapping(kind, from_world, axes, offset, on_sphere=version == 3)
