"""Meshes of shapes: sphere, disk, cylinder, rectangle, cube, bilinear patches, revolved profiles.

The vertices of round shapes are on the exact surface and have its normals; facets are inside of it.
The largest gap between both is at most ``error`` times the radius. u runs around the axis, from +x
toward +y, and v from the top (+z) down, so that (0, 0) is the top left of an image. Shapes face
outward, flat shapes toward +z; :meth:`ShapeMesh.flipped` reverses them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.checks import number
from daguerre.errors import InputError

Array = NDArray[np.float64]
#: Default of the largest gap between facets and the surface, in radii; for bilinear patches in
#: diagonals.
ERROR = 2e-4
#: Smallest gap that can be wanted: a sphere then has 10 million triangles.
_LEAST_ERROR = 1e-6
#: Sizes beyond do not fit into single precision.
_LARGEST = 1e37
#: Maximum number of cells of bilinear patches of one call.
_MOST_CELLS = 1 << 22
#: Columns of a rotation that takes +z to an axis.
TURNS = {"X": (1, 2, 0), "Y": (2, 0, 1), "Z": (0, 1, 2)}
#: Corners of a square, counter-clockwise.
SQUARE = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)


@dataclass(frozen=True, eq=False)
class ShapeMesh:
    """A mesh with normals and texture coordinates.

    Attributes:
        positions: Shape (N, 3), in the shape's own space.
        normals: Shape (N, 3).
        uv: Shape (N, 2); (0, 0) is the top left of an image.
        triangles: Shape (M, 3), counter-clockwise seen from outside.
    """

    positions: Array
    normals: Array
    uv: Array
    triangles: NDArray[np.int64]

    def flipped(self) -> ShapeMesh:
        """Returns the surface facing the opposite side."""
        return replace(self, normals=-self.normals, triangles=self.triangles[:, ::-1])


def sphere(
    radius: float = 1.0,
    low: float = -math.inf,
    high: float = math.inf,
    sweep: float = 360.0,
    error: float = ERROR,
) -> ShapeMesh | None:
    """A sphere about the origin, or the part of it between two heights; None if it has no area.

    v is linear in the angle from the highest ring to the lowest.

    Args:
        radius: Radius.
        low: Lowest z.
        high: Highest z.
        sweep: Angle about z, from +x, degrees.
        error: Largest gap between facets and sphere, in radii.

    Raises:
        InputError: A number is out of its range.
    """
    _check(radius, sweep, error)
    if radius == 0 or not low < high:
        return None
    bottom, top = (math.asin(min(max(z / radius, -1.0), 1.0)) for z in (low, high))
    # A facet between two meridians and two parallels of half a step s is cos(s)^2 radii away.
    around = _facets(math.asin(math.sqrt(error)), 360.0)
    across = max(math.ceil(around * (top - bottom) / (2 * math.pi)), 1)
    latitude = np.linspace(bottom, top, across + 1)
    slopes = np.stack([np.cos(latitude), np.sin(latitude)], axis=1)
    around = max(math.ceil(around * sweep / 360), 1)
    return revolved(slopes * radius, slopes, around=around, sweep=sweep)


def disk(
    radius: float = 1.0,
    inner: float = 0.0,
    height: float = 0.0,
    sweep: float = 360.0,
    error: float = ERROR,
) -> ShapeMesh | None:
    """A disk in the plane z = ``height`` that faces +z; None if it has no area.

    u runs around, v from the inner rim (0) to the outer rim (1).

    Args:
        radius: Outer radius.
        inner: Radius of the hole.
        height: z.
        sweep: Angle about z, from +x, degrees.
        error: Largest gap between rim and circle, in radii.

    Raises:
        InputError: A number is out of its range.
    """
    _check(radius, sweep, error)
    number(inner, "disk: inner", 0, radius, error=InputError)
    number(height, "disk: height", -_LARGEST, _LARGEST, error=InputError)
    profile = np.array([(radius, height), (inner, height)])
    around = _facets(math.acos(1 - error), sweep)
    return revolved(profile, np.array([(0.0, 1.0), (0.0, 1.0)]), around=around, sweep=sweep)


def cylinder(
    radius: float = 1.0,
    low: float = -1.0,
    high: float = 1.0,
    sweep: float = 360.0,
    error: float = ERROR,
) -> ShapeMesh | None:
    """The side of a cylinder about z, without ends; None if it has no area.

    Args:
        radius: Radius.
        low: z of the lower rim, v = 1.
        high: z of the upper rim, v = 0.
        sweep: Angle about z, from +x, degrees.
        error: Largest gap between facets and cylinder, in radii.

    Raises:
        InputError: A number is out of its range.
    """
    _check(radius, sweep, error)
    for name, z in (("low", low), ("high", high)):
        number(z, f"cylinder: {name}", -_LARGEST, _LARGEST, error=InputError)
    profile = np.array([(radius, min(low, high)), (radius, max(low, high))])
    around = _facets(math.acos(1 - error), sweep)
    return revolved(profile, np.array([(1.0, 0.0), (1.0, 0.0)]), around=around, sweep=sweep)


def rectangle(width: float = 2.0, length: float = 2.0) -> ShapeMesh | None:
    """A rectangle about the origin in the plane z = 0 that faces +z; None if it has no area.

    Args:
        width: Size along x.
        length: Size along y; the top of an image is at +y.
    """
    corners = np.zeros((1, 4, 3))
    corners[0, :, :2] = SQUARE * (0.5 * width, 0.5 * length)
    return quads(corners, np.array([(0.0, 0.0, 1.0)]))


def cube(size: float = 2.0) -> ShapeMesh | None:
    """A cube about the origin, each face with a whole image upright; None for a size of 0."""
    corners, normals = np.empty((6, 4, 3)), np.empty((6, 3))
    for face, (axis, sign) in enumerate((axis, sign) for axis in range(3) for sign in (-1.0, 1.0)):
        corners[face, :, axis] = sign
        corners[face, :, (axis + 1) % 3] = SQUARE[:, 0] * sign
        corners[face, :, (axis + 2) % 3] = SQUARE[:, 1]
        normals[face] = sign * np.eye(3)[axis]
    return quads(corners * (0.5 * size), normals)


def quads(corners: Array, normals: Array, uv: Array | None = None) -> ShapeMesh | None:
    """Separate flat parallelograms; None if they have no area.

    Args:
        corners: Corners, counter-clockwise, shape (F, 4, 3).
        normals: Shape (F, 3).
        uv: Texture coordinates of the corners, shape (4, 2) or (F, 4, 2); default: a whole image,
            with its lower left at the first corner.
    """
    count = len(corners)
    if uv is None:
        uv = SQUARE * (0.5, -0.5) + 0.5
    begins = 4 * np.arange(count)[:, None]
    triangles = np.concatenate([begins + three for three in ((0, 1, 2), (0, 2, 3))])
    return with_area(
        corners.reshape(-1, 3),
        np.repeat(normals, 4, axis=0),
        np.broadcast_to(uv, (count, 4, 2)).reshape(-1, 2),
        triangles,
    )


def bilinear(
    corners: ArrayLike,
    normals: ArrayLike | None = None,
    uv: ArrayLike | None = None,
    error: float = ERROR,
) -> ShapeMesh | None:
    """Bilinear patches that share no vertices; None if they have no area.

    A patch is p(u, v) = (1 - v) ((1 - u) p00 + u p10) + v ((1 - u) p01 + u p11), and faces the side
    of dp/du x dp/dv. All patches of a call have the same number of cells, so that patches with a
    common edge have no gap between them; a call makes at most 4,194,304 cells, even if ``error``
    would need more.

    Args:
        corners: p00, p10, p01 and p11, shape (F, 4, 3).
        normals: Normals at the corners, shape (F, 4, 3); default: normals of the surface.
        uv: Texture coordinates at the corners, shape (F, 4, 2); default: (u, 1 - v).
        error: Largest gap between cells and patch, in diagonals of the largest patch.

    Raises:
        InputError: ``error`` is out of its range.
    """
    number(error, "shape: error", _LEAST_ERROR, 0.5, error=InputError)
    points = np.asarray(corners, np.float64).reshape(-1, 4, 3)
    if not len(points):
        return None
    steps = _steps(points, error)
    u, v = (one.reshape(-1) for one in np.meshgrid(*[np.linspace(0, 1, steps + 1)] * 2))
    weights = np.stack([(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v], axis=1)

    def spread(values: ArrayLike) -> Array:
        given = np.asarray(values, np.float64).reshape(len(points), 4, -1)
        return np.asarray(np.matmul(weights, given).reshape(-1, given.shape[2]))

    flat = _bilinear_normals(points, u, v) if normals is None else spread(normals)
    if uv is None:
        coordinates = np.tile(np.stack([u, 1 - v], axis=1), (len(points), 1))
    else:
        coordinates = spread(uv)
    cells = _grid(steps + 1, steps + 1)
    begins = len(u) * np.arange(len(points))[:, None, None]
    return with_area(spread(points), _unit(flat), coordinates, (begins + cells).reshape(-1, 3))


def _steps(points: Array, error: float) -> int:
    """Cells along a side of bilinear patches.

    The distance of a cell from its two triangles is largest in its middle: a quarter of the twist
    p00 - p10 - p01 + p11, which falls with the square of the number of cells.
    """
    twist = np.linalg.norm(points[:, 0] - points[:, 1] - points[:, 2] + points[:, 3], axis=1)
    size = np.linalg.norm(np.ptp(points, axis=1), axis=1).max()
    steps = math.ceil(math.sqrt(twist.max() / (4 * error * size))) if size > 0 else 1
    return min(max(steps, 1), max(math.isqrt(_MOST_CELLS // len(points)), 1))


def _bilinear_normals(points: Array, u: Array, v: Array) -> Array:
    """Normals of bilinear patches, of any length, shape (F * K, 3)."""
    along = np.matmul(np.stack([v - 1, 1 - v, -v, v], axis=1), points)
    up = np.matmul(np.stack([u - 1, -u, 1 - u, u], axis=1), points)
    found = np.cross(along, up)
    # Where two corners coincide the surface has no normal; the patch's mean normal is close.
    whole = np.cross(points[:, 3] - points[:, 0], points[:, 2] - points[:, 1])
    lost = np.einsum("fkd,fkd->fk", found, found) == 0
    return np.asarray(np.where(lost[:, :, None], whole[:, None], found).reshape(-1, 3))


def _unit(vectors: Array) -> Array:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.asarray(vectors / np.where(lengths > 0, lengths, 1))


def revolved(
    profile: Array, slopes: Array, axis: str = "Z", around: int = 64, sweep: float = 360.0
) -> ShapeMesh | None:
    """Revolves a profile about an axis, from the bottom to the top; None if it has no area.

    Args:
        profile: Radius and height, shape (P, 2).
        slopes: Normals at these, shape (P, 2).
        axis: X, Y or Z.
        around: Facets around the axis.
        sweep: Angle, degrees.
    """
    angles = np.linspace(0, math.radians(sweep), around + 1)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    turn = list(np.argsort(TURNS[axis]))

    def swept(rows: Array) -> Array:
        flat = rows[:, None, :1] * circle
        high = np.broadcast_to(rows[:, None, 1:], (len(rows), len(angles), 1))
        return np.asarray(np.concatenate([flat, high], axis=2).reshape(-1, 3)[:, turn])

    rows = len(profile)
    v = np.linspace(1, 0, rows)
    u = np.linspace(0, 1, around + 1)
    uv = np.stack(np.meshgrid(u, v), axis=2).reshape(-1, 2)
    return with_area(swept(profile), swept(slopes), uv, _grid(around + 1, rows))


def _grid(columns: int, rows: int) -> NDArray[np.int64]:
    """Triangles between the points of a grid, row after row."""
    i = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1, 1)
    up = i + columns
    return np.concatenate([np.hstack([i, i + 1, up + 1]), np.hstack([i, up + 1, up])])


def with_area(
    positions: Array, normals: Array, uv: Array, triangles: NDArray[np.int64]
) -> ShapeMesh | None:
    """A mesh of the triangles that have an area; None if there are none."""
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    kept = triangles[areas > 1e-12 * max(float(areas.max(initial=0)), 1e-300)]
    return ShapeMesh(positions, normals, uv, kept) if len(kept) else None


def _facets(half: float, sweep: float) -> int:
    """Facets of an arc that are at most twice ``half`` (radians) wide; 4 n of a circle."""
    return max(math.ceil(4 * math.ceil(math.pi / half / 4) * sweep / 360), 1)


def _check(radius: float, sweep: float, error: float) -> None:
    number(radius, "shape: radius", 0, _LARGEST, error=InputError)
    number(sweep, "shape: sweep", 0, 360, error=InputError)
    number(error, "shape: error", _LEAST_ERROR, 0.5, error=InputError)
