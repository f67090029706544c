"""Surfaces of meshes as they are drawn: plain or subdivided, and over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daguerre.cached import cached_property
from daguerre.files.value import Value
from daguerre.motion.values import Dynamic
from daguerre.scene.motion import Vertices
from daguerre.scene.subdivision import Refiner

Array = NDArray[np.float32]
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Primvar:
    """Values of a surface.

    Attributes:
        values: Shape (N, K).
        interpolation: constant, uniform, vertex, varying or faceVarying.
        indices: Index of the value of each element, shape (M,); None: values in order.
    """

    values: Array
    interpolation: str
    indices: NDArray[np.int64] | None = None

    @property
    def flat(self) -> Array:
        """A value for each element, shape (M, K)."""
        return self.values if self.indices is None else self.values[self.indices]

    def __len__(self) -> int:
        return len(self.values if self.indices is None else self.indices)


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


class DrawnPolygons(Value):
    """Polygons of a mesh as they are drawn, without subdivision."""

    #: whether ``points`` has normals, and takes long
    smooth = False

    def __init__(self, faces: Faces) -> None:
        self._faces = faces

    @cached_property
    def _corners(self) -> Indices:
        """Corner (of ``Faces``) of each corner of a polygon."""
        return np.flatnonzero(np.repeat(~self._faces.holes, self._faces.sizes))

    @property
    def parents(self) -> Indices:
        """Face (of ``Faces``) of each polygon."""
        return np.flatnonzero(~self._faces.holes)

    @property
    def sizes(self) -> Indices:
        """Number of corners of each polygon."""
        return self._faces.sizes[~self._faces.holes]

    @property
    def vertices(self) -> Indices:
        """Vertex of each corner."""
        return self._faces.vertices[self._corners]

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


class Subdivided(DrawnPolygons):
    """The limit surface of a mesh, at a level of refinement."""

    smooth = True

    def __init__(self, faces: Faces, refiner: Refiner) -> None:
        self._faces, self._refiner = faces, refiner

    @property
    def parents(self) -> Indices:
        """Face (of ``Faces``) of each polygon."""
        return self._refiner.parents

    @property
    def sizes(self) -> Indices:
        """Number of corners of each polygon."""
        return self._refiner.sizes

    @property
    def vertices(self) -> Indices:
        """Vertex of each corner."""
        return self._refiner.vertices

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


@dataclass(frozen=True, eq=False)
class LimitOverTime(Value):
    """Vertices of a subdivision surface over time.

    Attributes:
        points: Control points over time, shape (P, 3).
        surface: The surface over them.
        origins: Vertex of the surface for each vertex of the mesh, shape (N,).
        rest: Vertices at a moment, with the attributes that do not change.
        flipped: Whether the mesh is left-handed, so that normals are reversed.
    """

    points: Dynamic
    surface: DrawnPolygons
    origins: NDArray[np.int64]
    rest: Vertices
    flipped: bool

    def at(self, time_s: float) -> Vertices:
        """Vertices at a time, s."""
        positions, normals = self.surface.points(np.asarray(self.points.at(time_s), np.float32))
        assert normals is not None
        turned = -normals if self.flipped else normals
        return replace(self.rest, positions=positions[self.origins], normals=turned[self.origins])

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Breaks of the points, s."""
        return [float(t) for t in self.points.breaks(begin, end)]
