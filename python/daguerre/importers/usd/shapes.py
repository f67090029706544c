"""Meshes of USD's solids: cube, sphere, cylinder, cone, capsule and plane.

Round shapes have 64 facets around, with corners on the surface; the largest gap to it is
0.12 % of the radius, and 0.24 % for spheres. Normals are exact. USD gives
solids no texture coordinates; here u runs around the axis, v along it, and faces show an image
upright.

Source: OpenUSD, documentation of UsdGeomCube and the other solids.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from daguerre.errors import InputError
from daguerre.scene.shapes import SQUARE, TURNS, ShapeMesh, cube, revolved, with_area

from .values import Clock

Array = NDArray[np.float64]
#: Attributes that give the size of a solid.
SIZES = ("size", "width", "length", "height", "radius", "radiusTop", "radiusBottom")
#: Sizes beyond do not fit into single precision.
_LARGEST = 1e37
#: Facets from pole to pole.
_ACROSS = 32


def solid_of(prim: Usd.Prim, clock: Clock) -> ShapeMesh | None:
    """Makes the mesh of a solid at the scene's time; None: another prim, or size 0.

    Raises:
        InputError: A size is not finite.
    """
    for kind, make in _SOLIDS.items():
        if prim.IsA(kind):
            made: ShapeMesh | None = make(_Sizes(prim, clock))
            return made
    return None


def is_solid(prim: Usd.Prim) -> bool:
    """Whether a prim is a solid."""
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
        return found if found in TURNS else "Z"


def _cube(sizes: _Sizes) -> ShapeMesh | None:
    return cube(sizes["size"])


def _plane(sizes: _Sizes) -> ShapeMesh | None:
    width, length, axis = sizes["width"], sizes["length"], sizes.axis
    corners = 0.5 * SQUARE
    # Source: UsdGeomPlane: width is along x (z for axis X), length along y (z for axis Y).
    across, along = {"X": (2, 1), "Y": (0, 2), "Z": (0, 1)}[axis]
    positions = np.zeros((4, 3))
    positions[:, across] = corners[:, 0] * width
    positions[:, along] = corners[:, 1] * length
    normals = np.repeat(np.eye(3)["XYZ".index(axis)][None], 4, axis=0)
    triangles = np.array([(0, 1, 2), (0, 2, 3)])
    if axis in "XY":  # x cross z is -y, z cross y is -x
        triangles = triangles[:, ::-1]
    # An image is upright for an observer on the axis with y up; for axis Y, with -z up.
    upright = {"X": (-1, -1), "Y": (1, 1), "Z": (1, -1)}[axis]
    return with_area(positions, normals, corners * upright + 0.5, triangles)


def ball(radius: float) -> ShapeMesh | None:
    """A sphere about the origin; None for a radius of 0."""
    return _hull((radius, radius), 0.0, "Z")


def _sphere(sizes: _Sizes) -> ShapeMesh | None:
    return ball(sizes["radius"])


def _capsule(sizes: _Sizes) -> ShapeMesh | None:
    return _hull(sizes.radii, sizes["height"], sizes.axis)


def _hull(radii: tuple[float, float], height: float, axis: str) -> ShapeMesh | None:
    """Hull of two balls, the second higher on the axis by ``height``.

    Its side touches both at a latitude: its sine is the difference of radii over the height.
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
    """Latitudes of rings; a single ring, of no height, where the other ball covers this ball."""
    return np.linspace(low, high, math.ceil(_ACROSS * (high - low) / math.pi) + 1)


def _cylinder(sizes: _Sizes) -> ShapeMesh | None:
    return _frustum(*sizes.radii, sizes["height"], sizes.axis)


def _cone(sizes: _Sizes) -> ShapeMesh | None:
    return _frustum(sizes["radius"], 0.0, sizes["height"], sizes.axis)


def _frustum(bottom: float, top: float, height: float, axis: str) -> ShapeMesh | None:
    length = math.hypot(height, bottom - top) or 1.0
    side = (height / length, (bottom - top) / length)
    low, high = -0.5 * height, 0.5 * height
    profile = [(0, low), (bottom, low), (bottom, low), (top, high), (top, high), (0, high)]
    slopes = [(0, -1), (0, -1), side, side, (0, 1), (0, 1)]
    return revolved(np.array(profile, float), np.array(slopes, float), axis)


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
