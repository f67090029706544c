"""Reads shapes as meshes in object space.

The front of a surface is the side of its normals ``N``, or else that from which its corners run
counter-clockwise, whatever its transform is; ``ReverseOrientation`` exchanges both sides.

Source: pbrt-v4's user's guide ("Shapes"), and its code for sides and texture coordinates.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import asked_by
from daguerre.files.notes import Notes
from daguerre.importers.meshes import ply
from daguerre.scene import shapes as solids
from daguerre.scene.polygons import triangulate

from .files import Files
from .state import Entity

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
_MOST_INDEX = (1 << 31) - 1
_MOST_LEVELS, _MOST_FACES = 10, 1 << 20
#: Corners of triangles without texture coordinates, u and v (pbrt's ``Triangle::GetUVs``).
_DEFAULT_UV = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])


@dataclass(frozen=True, eq=False)
class LocalMesh:
    """A mesh in object space.

    Attributes:
        positions: Shape (N, 3), m.
        triangles: Shape (M, 3), wound so that their fronts are the surface's front.
        normals: Shape (N, 3), or None.
        uv: Texture coordinates, shape (N, 2), with (0, 0) at the bottom left; or None.
        area: Exact area of a shape that is a single light; None: each triangle or patch is a light.
        patch: Patch of each triangle, shape (M,); None: no patches.
        level: Levels of Loop subdivision.
        size: Factor on all positions.
        key: Content of a shape that many directives share; None: not shared.
        name: Name of the shape's file; empty: no file.
    """

    positions: NDArray[np.floating]
    triangles: IntArray
    normals: NDArray[np.floating] | None = None
    uv: NDArray[np.floating] | None = None
    area: float | None = None
    patch: IntArray | None = None
    level: int = 0
    size: float = 1.0
    key: tuple[object, ...] | None = None
    name: str = ""

    def faced(self) -> LocalMesh:
        """The same surface, with triangles that face the side of its normals."""
        if self.normals is None:
            return self
        corners = self.positions[self.triangles].astype(np.float64)
        faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        wanted = self.normals[self.triangles].sum(axis=1)
        behind = np.einsum("ij,ij->i", faces, wanted) < 0
        if not behind.any():
            return self
        triangles = self.triangles.copy()
        triangles[behind] = triangles[behind][:, ::-1]
        return replace(self, triangles=triangles)

    def reversed(self) -> LocalMesh:
        """The same surface, with its sides exchanged."""
        normals = None if self.normals is None else -self.normals
        key = None if self.key is None else (*self.key, "reversed")
        return replace(self, normals=normals, triangles=self.triangles[:, ::-1], key=key)

    def with_uv(self) -> LocalMesh:
        """The same surface; without texture coordinates, each triangle gets pbrt's."""
        if self.uv is not None or self.level:
            return self
        flat = self.triangles.reshape(-1)
        return replace(
            self,
            positions=self.positions[flat],
            normals=None if self.normals is None else self.normals[flat],
            triangles=np.arange(len(flat)).reshape(-1, 3),
            uv=np.tile(_DEFAULT_UV, (len(self.triangles), 1)),
            key=None if self.key is None else (*self.key, "uv"),
        )


def surface_of(entity: Entity, files: Files, notes: Notes) -> LocalMesh | str:
    """Reads a shape, or notes why it is left out: unsupported kind, or no area.

    Raises:
        InputError: A parameter or a file is wrong.
    """
    reader = _KINDS.get(entity.kind)
    if reader is None:
        return f"a shape of kind {entity.kind[:40]!r} is left out"
    found = reader(entity, files, notes)
    if found is None:
        return f"a {entity.kind} without an area is left out"
    if isinstance(found, str):
        return found
    return found.reversed() if entity.state.reversed else found


def _triangles(entity: Entity, files: Files, notes: Notes) -> LocalMesh | str | None:
    del files
    positions = _positions(entity)
    indices = entity.parameters.integers("indices", 0, _MOST_INDEX)
    if indices is None:
        if len(positions) != 3:
            entity.place.fail("indices: missing")
        indices = np.arange(3)
    rows = _indices(entity, indices, 3, len(positions))
    if entity.parameters.find("S") is not None or entity.parameters.find("faceIndices") is not None:
        notes.add("'S' or 'faceIndices' of a trianglemesh is not used")
    return LocalMesh(
        positions, rows, _values(entity, "N", positions, notes), _uv(entity, positions, notes)
    ).faced()


def _loop(entity: Entity, files: Files, notes: Notes) -> LocalMesh | str | None:
    del files
    positions = _positions(entity)
    indices = entity.parameters.integers("indices", 0, _MOST_INDEX)
    if indices is None:
        entity.place.fail("indices: missing")
    name = "levels" if entity.parameters.has("levels") else "nlevels"
    level = entity.parameters.integer(name, 3, 0, _MOST_LEVELS)
    entity.parameters.find("scheme")
    rows = _indices(entity, indices, 3, len(positions))
    while level > 1 and len(rows) << 2 * level > _MOST_FACES:
        level -= 1
        notes.add("a loopsubdiv surface with very many faces gets fewer levels")
    return LocalMesh(positions, rows, level=level)


def _patches(entity: Entity, files: Files, notes: Notes) -> LocalMesh | str | None:
    del files
    positions = _positions(entity)
    indices = entity.parameters.integers("indices", 0, _MOST_INDEX)
    if indices is None:
        if len(positions) != 4:
            entity.place.fail("indices: missing")
        indices = np.arange(4)
    rows = _indices(entity, indices, 4, len(positions))
    normals, uv = _values(entity, "N", positions, notes), _uv(entity, positions, notes)
    if entity.parameters.find("emissionfilename") is not None:
        notes.add("'emissionfilename' of a bilinearmesh is not used")
    found = solids.bilinear(
        positions[rows],
        None if normals is None else normals[rows],
        None if uv is None else _down(uv[rows]),
    )
    surface = _of_solid(found, None, None)
    if surface is None:
        return None
    each = len(surface.positions) // len(rows)  # patches share no vertices
    return replace(surface, patch=surface.triangles[:, 0] // each)


def _plymesh(entity: Entity, files: Files, notes: Notes) -> LocalMesh | str | None:
    name = entity.parameters.text("filename") or entity.place.fail("filename: missing")
    path = files.find(name, entity.place, "filename")
    for unused in ("displacement", "displacement.uvscale", "edgelength"):
        if entity.parameters.find(unused) is not None:
            notes.add(f"{unused!r} of a plymesh is not used")
    if path is None:
        return "a mesh whose file is missing is left out"
    with asked_by(entity.place):
        mesh = ply.read(path, notes)
    corners = mesh.corners.astype(np.int64)
    if mesh.sizes is None:
        triangles, patch = corners.reshape(-1, 3), None
    else:
        found, patch = triangulate(mesh.sizes, corners, mesh.positions)
        triangles = corners[found]
    count = len(mesh.positions)
    normals = mesh.normals if mesh.normals is not None and len(mesh.normals) == count else None
    uv = mesh.uv if mesh.uv is not None and len(mesh.uv) == count else None
    name = path.stem.split(".")[0]
    made_of = LocalMesh(mesh.positions, triangles, normals, uv, patch=patch, name=name)
    return made_of.faced() if len(triangles) else None


def _sphere(entity: Entity, files: Files, notes: Notes) -> LocalMesh | str | None:
    del files, notes
    number = entity.parameters.number
    radius = number("radius", 1.0, 0.0)
    low, high = number("zmin", -radius), number("zmax", radius)
    low, high = (min(max(z, -radius), radius) for z in sorted((low, high)))
    sweep = _sweep(entity)
    error = 1e-3 if entity.state.emission is not None else solids.ERROR
    area = np.radians(sweep) * radius * (high - low)
    if radius == 0:
        return None
    ends = low / radius, high / radius  # spheres of all sizes share a mesh
    with asked_by(entity.place):
        solid = _part_of_sphere(*ends, sweep, error)
    found = _of_solid(solid, area, ("sphere", *ends, sweep, error))
    return None if found is None else replace(found, size=radius)


@lru_cache(maxsize=16)
def _part_of_sphere(low: float, high: float, sweep: float, error: float) -> solids.ShapeMesh | None:
    """Part of a sphere of radius 1; scenes have many alike."""
    return solids.sphere(1.0, low, high, sweep, error)


def _disk(entity: Entity, files: Files, notes: Notes) -> LocalMesh | str | None:
    del files, notes
    number = entity.parameters.number
    radius, height = number("radius", 1.0, 0.0), number("height", 0.0)
    inner = min(number("innerradius", 0.0, 0.0), radius)
    sweep = _sweep(entity)
    area = np.radians(sweep) * 0.5 * (radius**2 - inner**2)
    key = ("disk", radius, inner, height, sweep)
    with asked_by(entity.place):
        return _of_solid(solids.disk(radius, inner, height, sweep), area, key)


def _cylinder(entity: Entity, files: Files, notes: Notes) -> LocalMesh | str | None:
    del files, notes
    number = entity.parameters.number
    radius, low, high = number("radius", 1.0, 0.0), number("zmin", -1.0), number("zmax", 1.0)
    sweep = _sweep(entity)
    area = abs(high - low) * radius * np.radians(sweep)
    key = ("cylinder", radius, low, high, sweep)
    with asked_by(entity.place):
        return _of_solid(solids.cylinder(radius, low, high, sweep), area, key)


def _sweep(entity: Entity) -> float:
    return entity.parameters.number("phimax", 360.0, 0.0, 360.0)


def _of_solid(
    solid: solids.ShapeMesh | None, area: float | None, key: tuple[object, ...] | None
) -> LocalMesh | None:
    if solid is None:
        return None
    uv = _down(solid.uv)
    return LocalMesh(solid.positions, solid.triangles, solid.normals, uv, area, key=key)


def _down(uv: Array) -> Array:
    """Texture coordinates with v in the other direction."""
    return uv * (1.0, -1.0) + (0.0, 1.0)


def _positions(entity: Entity) -> Array:
    found = entity.parameters.points("P", "point3", "vector3")
    if found is None or not len(found):
        entity.place.fail("P: missing")
    return found


def _indices(entity: Entity, indices: IntArray, each: int, count: int) -> IntArray:
    parameter = entity.parameters.find("indices")
    fail = entity.place.fail if parameter is None else parameter.fail
    if len(indices) % each:
        fail(f"wanted a multiple of {each} indices, got {len(indices)}")
    if not len(indices):
        fail("empty")
    if indices.max() >= count:
        fail(f"wanted indices of 0 .. {count - 1}, got {indices.max()}")
    return indices.reshape(-1, each)


def _values(entity: Entity, name: str, positions: Array, notes: Notes) -> Array | None:
    """Normals at the vertices; None: there are none that can be used."""
    found = entity.parameters.points(name, "normal", "vector3", "point3")
    if found is not None and len(found) != len(positions):
        notes.add(f"{name!r} of a {entity.kind} without the length of 'P' is left out")
        return None
    return found


def _uv(entity: Entity, positions: Array, notes: Notes) -> Array | None:
    """Texture coordinates at the vertices; pbrt-v3 has them as plain numbers, too."""
    for name in ("uv", "st"):
        found = entity.parameters.find(name)
        if found is None:
            continue
        if found.type in ("float", "point2", "vector2"):
            values = found.numbers
            if len(values) == 2 * len(positions):
                return values.reshape(-1, 2)
            notes.add(f"{name!r} of a {entity.kind} without the length of 'P' is left out")
        else:
            found.fail(f"wanted type point2 or float, got {found.type}")
    return None


_KINDS: dict[str, Callable[[Entity, Files, Notes], LocalMesh | str | None]] = {
    "trianglemesh": _triangles,
    "loopsubdiv": _loop,
    "bilinearmesh": _patches,
    "plymesh": _plymesh,
    "sphere": _sphere,
    "disk": _disk,
    "cylinder": _cylinder,
}
