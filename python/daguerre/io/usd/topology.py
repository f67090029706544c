"""Reads the faces of meshes, and makes the surfaces that are drawn: plain or subdivided."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import UsdGeom

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.files.value import Value
from daguerre.scene.subdivision import Refiner, Rules, edges_of_chains

from .primvars import Array, Primvar
from .values import Clock

Indices = NDArray[np.int64]
_SCHEMES = {"catmullClark": "catmull-clark", "loop": "loop", "bilinear": "bilinear"}
_BOUNDARIES = {"edgeAndCorner": "edge and corner", "edgeOnly": "edge only", "none": "none"}
_FACE_VARYING = {
    "cornersPlus1": "corners plus1",
    "cornersPlus2": "corners plus2",
    "cornersOnly": "corners only",
    "boundaries": "boundaries",
    "none": "none",
    "all": "all",
}


@dataclass(frozen=True, eq=False)
class Faces:
    """Faces of a mesh that have three corners or more.

    Attributes:
        count: Number of points.
        sizes: Number of corners of each face, shape (F,).
        vertices: Point of each corner, shape (C,).
        ids: Number of each face in the file, shape (F,).
        corner_ids: Number of each corner in the file, shape (C,).
        stated: Numbers of faces and corners in the file.
        holes: Whether a face is not drawn, shape (F,).
    """

    count: int
    sizes: Indices
    vertices: Indices
    ids: Indices
    corner_ids: Indices
    stated: tuple[int, int]
    holes: NDArray[np.bool_]


def read_faces(mesh: UsdGeom.Mesh, count: int, clock: Clock, notes: Notes) -> Faces:
    """Reads the faces of a mesh at the scene's time.

    Args:
        mesh: The mesh.
        count: Number of its points.
        clock: Time codes of the stage.
        notes: Receives a note on faces of fewer than three corners.

    Raises:
        InputError: They do not fit together, or name points that do not exist.
    """
    sizes = _integers(mesh.GetFaceVertexCountsAttr().Get(clock.code))
    vertices = _integers(mesh.GetFaceVertexIndicesAttr().Get(clock.code))
    where = f"{clock.file}: {mesh.GetPath()}"
    if sizes.size and sizes.min() < 0:
        raise InputError(f"{where}: faceVertexCounts: wanted at least 0, got {sizes.min()}")
    if int(sizes.sum()) != len(vertices):
        raise InputError(
            f"{where}: faceVertexIndices: wanted {int(sizes.sum())}, the sum of "
            f"faceVertexCounts, got {len(vertices)}"
        )
    if vertices.size and not (vertices.min() >= 0 and vertices.max() < count):
        worst = vertices.max() if vertices.min() >= 0 else vertices.min()
        raise InputError(f"{where}: faceVertexIndices: wanted 0 .. {count - 1}, got {worst}")
    kept = sizes >= 3
    if not kept.all():
        notes.add("a face of fewer than three corners is left out", int((~kept).sum()))
    holes = _integers(mesh.GetHoleIndicesAttr().Get(clock.code))
    hidden = np.zeros(len(sizes), bool)
    hidden[holes[(holes >= 0) & (holes < len(sizes))]] = True
    corners = np.flatnonzero(np.repeat(kept, sizes))
    ids = np.flatnonzero(kept)
    stated = len(sizes), len(vertices)
    return Faces(count, sizes[ids], vertices[corners], ids, corners, stated, hidden[ids])


def _integers(value: Any) -> Indices:
    return np.zeros(0, np.int64) if value is None else np.asarray(value, np.int64).reshape(-1)


class Surface(Value):
    """Polygons of a mesh as they are drawn, without subdivision."""

    #: whether ``points`` has normals, and takes long
    smooth = False

    def __init__(self, faces: Faces) -> None:
        self._faces = faces
        drawn = ~faces.holes
        self._corners = np.flatnonzero(np.repeat(drawn, faces.sizes))
        #: face (of ``Faces``) of each polygon
        self.parents = np.flatnonzero(drawn)
        self.sizes = faces.sizes[drawn]
        self.vertices = faces.vertices[self._corners]

    @property
    def face_ids(self) -> Indices:
        """Number of the face in the file for each polygon."""
        return self._faces.ids[self.parents]

    def points(self, points: Array) -> tuple[Array, Array | None]:
        """Positions of the vertices, and their normals if the surface is smooth by nature."""
        return points, None

    def corners(self, primvar: Primvar) -> Array | None:
        """Values at the corners of the polygons, shape (C, K); None if their number is wrong."""
        faces, kind = self._faces, primvar.interpolation
        wanted = {"constant": 1, "uniform": faces.stated[0], "faceVarying": faces.stated[1]}
        if len(primvar) != wanted.get(kind, faces.count):
            return None
        if kind == "faceVarying":
            return self._face_varying(primvar)
        if kind in ("constant", "uniform"):
            each = self.face_ids if kind == "uniform" else np.zeros(len(self.parents), np.int64)
            return np.repeat(primvar.flat[each], self.sizes, axis=0)
        return self._smooth(primvar.flat, kind)

    def _face_varying(self, primvar: Primvar) -> Array:
        return primvar.flat.take(self._faces.corner_ids[self._corners], axis=0)

    def _smooth(self, values: Array, kind: str) -> Array:
        return values.take(self.vertices, axis=0)


class Subdivided(Surface):
    """The limit surface of a mesh, at a level of refinement."""

    smooth = True

    def __init__(self, faces: Faces, mesh: UsdGeom.Mesh, level: int, clock: Clock) -> None:
        self._faces = faces
        self._refiner = Refiner(
            faces.count,
            faces.sizes,
            faces.vertices,
            scheme=_SCHEMES[scheme_of(mesh, clock)],
            level=level,
            rules=_rules(mesh, faces, clock),
            where=f"{clock.file}: {mesh.GetPath()}",
        )
        self.parents = self._refiner.parents
        self.sizes = self._refiner.sizes
        self.vertices = self._refiner.vertices

    def points(self, points: Array) -> tuple[Array, Array | None]:
        """Positions on the limit surface and their normals."""
        positions, normals = self._refiner.surface(points)
        return positions.astype(np.float32), normals.astype(np.float32)

    def _face_varying(self, primvar: Primvar) -> Array:
        corners, indices = self._faces.corner_ids, primvar.indices
        if indices is None:
            found = self._refiner.face_varying(primvar.values[corners])
        else:
            found = self._refiner.face_varying(primvar.values, indices[corners])
        return np.asarray(found, np.float32)

    def _smooth(self, values: Array, kind: str) -> Array:
        refine = self._refiner.vertex if kind == "vertex" else self._refiner.varying
        return np.asarray(refine(values), np.float32).take(self.vertices, axis=0)


def scheme_of(mesh: UsdGeom.Mesh, clock: Clock) -> str:
    """Scheme of subdivision, as USD names it; ``none`` for a polygon mesh."""
    return str(mesh.GetSubdivisionSchemeAttr().Get(clock.code) or "none")


def surface_of(faces: Faces, mesh: UsdGeom.Mesh, level: int, clock: Clock, notes: Notes) -> Surface:
    """Makes the surface of a mesh in its scheme of subdivision."""
    scheme = scheme_of(mesh, clock)
    if scheme not in _SCHEMES or not len(faces.sizes):
        if scheme not in (*_SCHEMES, "none"):
            notes.add(f"subdivision scheme {scheme[:40]!r} is unknown: the mesh is not subdivided")
        return Surface(faces)
    if scheme == "loop" and (faces.sizes != 3).any():
        notes.add(
            "a mesh for Loop's subdivision has faces other than triangles: it is not subdivided"
        )
        return Surface(faces)
    return Subdivided(faces, mesh, level, clock)


def _rules(mesh: UsdGeom.Mesh, faces: Faces, clock: Clock) -> Rules:
    """Creases, corners, boundaries and holes of a mesh, as the file states them."""
    code = clock.code
    where = f"{clock.file}: {mesh.GetPath()}"
    creases, sharpness = edges_of_chains(
        _integers(mesh.GetCreaseIndicesAttr().Get(code)),
        _integers(mesh.GetCreaseLengthsAttr().Get(code)),
        _numbers(mesh.GetCreaseSharpnessesAttr().Get(code)),
        where,
    )
    boundary = str(mesh.GetInterpolateBoundaryAttr().Get(code))
    linear = str(mesh.GetFaceVaryingLinearInterpolationAttr().Get(code))
    return Rules(
        creases=creases,
        crease_sharpness=sharpness,
        corners=_integers(mesh.GetCornerIndicesAttr().Get(code)),
        corner_sharpness=_numbers(mesh.GetCornerSharpnessesAttr().Get(code)),
        boundary=_BOUNDARIES.get(boundary, "edge and corner"),
        face_varying=_FACE_VARYING.get(linear, "corners plus1"),
        holes=np.flatnonzero(faces.holes),
    )


def _numbers(value: Any) -> NDArray[np.float64]:
    return np.zeros(0) if value is None else np.asarray(value, np.float64).reshape(-1)
