"""Meshes of USD's solids: cube, sphere, cylinder, cone, capsule and plane.

Round shapes are made of facets whose corners lie on the surface; the largest gap to it is
``1 - cos(pi / 64)``, 0.12 % of the radius. Normals are those of the exact surface. USD gives solids
no texture coordinates; here u runs around the axis, v along it, and faces show an image upright.

Source: OpenUSD, documentation of UsdGeomCube and the other solids.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from daguerre.errors import InputError

from .values import Clock

Array = NDArray[np.float64]
#: Attributes that give the size of a solid.
SIZES = ("size", "width", "length", "height", "radius", "radiusTop", "radiusBottom")
#: Sizes beyond do not fit into single precision.
_LARGEST = 1e37
#: Facets around, and from pole to pole.
_AROUND, _ACROSS = 64, 32
#: Columns of a rotation that takes +z to an axis.
_TURNS = {"X": (1, 2, 0), "Y": (2, 0, 1), "Z": (0, 1, 2)}


@dataclass(frozen=True, eq=False)
class Solid:
    """A mesh with normals and texture coordinates.

    Attributes:
        positions: Shape (N, 3), in the prim's space.
        normals: Shape (N, 3).
        uv: Shape (N, 2); (0, 0) is the top left of an image.
        triangles: Shape (M, 3), counter-clockwise seen from outside.
    """

    positions: Array
    normals: Array
    uv: Array
    triangles: NDArray[np.int64]


def solid_of(prim: Usd.Prim, clock: Clock) -> Solid | None:
    """Makes the mesh of a solid at the scene's time; None for another prim, or one of size 0.

    Raises:
        InputError: A size is not finite.
    """
    for kind, make in _SOLIDS.items():
        if prim.IsA(kind):
            made: Solid | None = make(_Sizes(prim, clock))
            return made
    return None


def is_solid(prim: Usd.Prim) -> bool:
    """Whether a prim is one of the solids."""
    return any(prim.IsA(kind) for kind in _SOLIDS)


class _Sizes:
    """Attributes of a solid."""

    def __init__(self, prim: Usd.Prim, clock: Clock) -> None:
        self._prim = prim
        self._clock = clock

    def __getitem__(self, name: str) -> float:
        found = self._clock.now(self._prim.GetAttribute(name))
        if not isinstance(found, int | float) or not abs(found) <= _LARGEST:
            raise InputError(
                f"{self._clock.file}: {self._prim.GetPath()}.{name}: wanted a finite number, "
                f"got {str(found)[:60]}"
            )
        return abs(float(found))

    @property
    def radii(self) -> tuple[float, float]:
        """Radii at the bottom and the top."""
        if self._prim.HasAttribute("radiusTop"):
            return self["radiusBottom"], self["radiusTop"]
        return self["radius"], self["radius"]

    @property
    def axis(self) -> str:
        """Axis of the solid, X, Y or Z."""
        found = str(self._clock.now(self._prim.GetAttribute("axis")))
        return found if found in _TURNS else "Z"


def _cube(sizes: _Sizes) -> Solid | None:
    half = 0.5 * sizes["size"]
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)
    positions, normals = [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            face = np.empty((4, 3))
            face[:, axis] = sign
            face[:, (axis + 1) % 3] = corners[:, 0] * sign
            face[:, (axis + 2) % 3] = corners[:, 1]
            positions.append(face * half)
            normals.append(np.repeat(sign * np.eye(3)[axis][None], 4, axis=0))
    uv = np.tile((corners * (0.5, -0.5)) + 0.5, (6, 1))
    quads = 4 * np.arange(6)[:, None]
    triangles = np.concatenate([quads + corner for corner in ((0, 1, 2), (0, 2, 3))])
    return _whole(np.concatenate(positions), np.concatenate(normals), uv, triangles)


def _plane(sizes: _Sizes) -> Solid | None:
    width, length, axis = sizes["width"], sizes["length"], sizes.axis
    corners = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
    # Source: UsdGeomPlane: width lies along x (z for axis X), length along y (z for axis Y).
    across, along = {"X": (2, 1), "Y": (0, 2), "Z": (0, 1)}[axis]
    positions = np.zeros((4, 3))
    positions[:, across] = corners[:, 0] * width
    positions[:, along] = corners[:, 1] * length
    normals = np.repeat(np.eye(3)["XYZ".index(axis)][None], 4, axis=0)
    triangles = np.array([(0, 1, 2), (0, 2, 3)])
    if axis in "XY":  # x cross z is -y, z cross y is -x
        triangles = triangles[:, ::-1]
    # An image is upright for an observer on the axis whose up is y; for axis Y, -z.
    upright = {"X": (-1, -1), "Y": (1, 1), "Z": (1, -1)}[axis]
    return _whole(positions, normals, corners * upright + 0.5, triangles)


def ball(radius: float) -> Solid | None:
    """A sphere about the origin; None for a radius of 0."""
    return _hull((radius, radius), 0.0, "Z")


def _sphere(sizes: _Sizes) -> Solid | None:
    return ball(sizes["radius"])


def _capsule(sizes: _Sizes) -> Solid | None:
    return _hull(sizes.radii, sizes["height"], sizes.axis)


def _hull(radii: tuple[float, float], height: float, axis: str) -> Solid | None:
    """Hull of two balls, the second one higher on the axis by ``height``.

    Its side touches both at the latitude whose sine is the difference of radii over the height.
    """
    slope = radii[0] - radii[1]
    sine = min(max(slope / height, -1.0), 1.0) if height > 0 else float(np.sign(slope))
    middle = math.asin(sine)
    below, above = _latitudes(-0.5 * math.pi, middle), _latitudes(middle, 0.5 * math.pi)
    latitude = np.concatenate([below, above])
    slopes = np.stack([np.cos(latitude), np.sin(latitude)], axis=1)
    size = np.where(np.arange(len(latitude)) < len(below), *radii)
    profile = slopes * size[:, None]
    profile[: len(below), 1] -= 0.5 * height
    profile[len(below) :, 1] += 0.5 * height
    return revolved(profile, slopes, axis)


def _latitudes(low: float, high: float) -> Array:
    """Latitudes of rings; a single one, of no size, where the other ball covers this one."""
    return np.linspace(low, high, math.ceil(_ACROSS * (high - low) / math.pi) + 1)


def _cylinder(sizes: _Sizes) -> Solid | None:
    return _frustum(*sizes.radii, sizes["height"], sizes.axis)


def _cone(sizes: _Sizes) -> Solid | None:
    return _frustum(sizes["radius"], 0.0, sizes["height"], sizes.axis)


def _frustum(bottom: float, top: float, height: float, axis: str) -> Solid | None:
    length = math.hypot(height, bottom - top) or 1.0
    side = (height / length, (bottom - top) / length)
    low, high = -0.5 * height, 0.5 * height
    profile = [(0, low), (bottom, low), (bottom, low), (top, high), (top, high), (0, high)]
    slopes = [(0, -1), (0, -1), side, side, (0, 1), (0, 1)]
    return revolved(np.array(profile, float), np.array(slopes, float), axis)


def revolved(profile: Array, slopes: Array, axis: str) -> Solid | None:
    """Revolves a profile of (radius, height) about an axis, from the bottom to the top."""
    angles = np.linspace(0, 2 * math.pi, _AROUND + 1)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    turn = list(np.argsort(_TURNS[axis]))

    def swept(rows: Array) -> Array:
        flat = rows[:, None, :1] * circle
        high = np.broadcast_to(rows[:, None, 1:], (len(rows), len(angles), 1))
        return np.concatenate([flat, high], axis=2).reshape(-1, 3)[:, turn]

    rows = len(profile)
    v = np.linspace(1, 0, rows)
    u = np.linspace(0, 1, _AROUND + 1)
    uv = np.stack(np.meshgrid(u, v), axis=2).reshape(-1, 2)
    i = (np.arange(rows - 1)[:, None] * (_AROUND + 1) + np.arange(_AROUND)).reshape(-1, 1)
    up = i + _AROUND + 1
    triangles = np.concatenate([np.hstack([i, i + 1, up + 1]), np.hstack([i, up + 1, up])])
    return _whole(swept(profile), swept(slopes), uv, triangles)


def _whole(
    positions: Array, normals: Array, uv: Array, triangles: NDArray[np.int64]
) -> Solid | None:
    """A solid without triangles of no area."""
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    kept = triangles[areas > 1e-12 * max(float(areas.max(initial=0)), 1e-300)]
    return Solid(positions, normals, uv, kept) if len(kept) else None


_SOLIDS: dict[Any, Any] = {
    UsdGeom.Cube: _cube,
    UsdGeom.Sphere: _sphere,
    UsdGeom.Cylinder: _cylinder,
    UsdGeom.Cylinder_1: _cylinder,
    UsdGeom.Capsule: _capsule,
    UsdGeom.Capsule_1: _capsule,
    UsdGeom.Cone: _cone,
    UsdGeom.Plane: _plane,
}
