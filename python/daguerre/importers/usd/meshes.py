"""Reads meshes: polygons and subdivision surfaces, whole or in subsets by material."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from pxr import UsdGeom

from daguerre.checks import freeze_in_place
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.motion.values import Composite, Dynamic, is_dynamic
from daguerre.scene.motion import Vertices
from daguerre.scene.over_time.points import ChosenOverTime
from daguerre.scene.over_time.surfaces import Array, DrawnPolygons, LimitOverTime
from daguerre.scene.point_cache import PointCache
from daguerre.scene.polygons import triangulate, weld
from daguerre.scene.scene import Scene

from .normals import Normals, read_normals
from .primvars import note_length, read_primvar
from .topology import read_faces, surface_of
from .values import Clock

if TYPE_CHECKING:
    from pxr import Usd


#: Limit faces of all subdivision surfaces of a stage that decide the level of each.
_DETAIL = 1_500_000
#: Largest number of limit faces of a surface, and of levels.
_MOST_FACES, _MOST_LEVELS = 250_000, 4
#: Names of texture coordinates where a material names none.
USUAL_UV = ("st", "UVMap", "map1", "st0", "uv")
_ATTRIBUTES = ("normals", "uv", "uv1", "colors")


@dataclass(frozen=True)
class Choice:
    """Faces and coordinates of a mesh that a material needs.

    Attributes:
        subset: Name of the subset of faces; empty for all.
        uv_sets: Names of the primvars that are texture coordinates 0 and 1.
        colored: Whether ``displayColor`` colours the vertices.
    """

    subset: str
    uv_sets: tuple[str, ...]
    colored: bool


@dataclass(frozen=True, eq=False)
class Shape:
    """A mesh of the file, before it is cut into parts.

    Attributes:
        prim: The prim.
        points: Points, or points over time.
        surface: Polygons of the mesh.
        flipped: Whether the polygons are left-handed.
        begun: Positions and normals of the surface's vertices at the scene's time.
        rest: Points before a skin moved them, to which the normals of the file belong; or None.
        normals: Normals of the file; None: the surface is smooth by nature, or flat.
    """

    prim: Usd.Prim
    points: Array | Dynamic
    surface: DrawnPolygons
    flipped: bool
    begun: Future[tuple[Array, Array | None]]
    rest: Array | None
    normals: Normals | None


#: Points of a mesh, constant or over time, and the same before a skin moved them.
Points = tuple["Array | Dynamic", "Array | Dynamic"]


class Meshes:
    """Meshes of a stage, each added to the scene once for each choice.

    Args:
        scene: Receives the meshes.
        clock: Time codes of the stage.
        count: Faces of all subdivision meshes of the stage.
        notes: Receives notes on unsupported content.
    """

    def __init__(self, scene: Scene, clock: Clock, count: int, notes: Notes) -> None:
        self._scene = scene
        self._clock = clock
        self._count = count
        self._notes = notes
        self._points: dict[str, Points] = {}
        self._last: tuple[str, Shape | None] | None = None
        self._made: dict[tuple[str, Choice], int | None] = {}
        self._pool = ThreadPoolExecutor(1)

    def close(self) -> None:
        """Ends the thread that finds limits of surfaces."""
        self._pool.shutdown(cancel_futures=True)

    def index(
        self,
        source: str,
        prim: object,
        read: Callable[[], Points],
        choice: Choice,
        faces: NDArray[np.int64] | None = None,
    ) -> int | None:
        """Index of the mesh of the scene; None if it has no faces or no points.

        Args:
            source: Path of the prim that instances share.
            prim: The prim.
            read: Reads points, constant or over time, after and before skinning.
            choice: Faces and coordinates.
            faces: Faces of the subset; None for all.
        """
        key = (source, choice)
        if key not in self._made:
            shape = self._shape_of(source, prim, read)
            self._made[key] = None if shape is None else self._add(shape, choice, faces)
        return self._made[key]

    def _shape_of(self, source: str, prim: object, read: Callable[[], Points]) -> Shape | None:
        """Shape of a prim; the last shape is cached, as parts of a prim follow each other.

        A shape that is made again later, for another choice, adds no new notes.
        """
        if self._last is None or self._last[0] != source:
            self._last = None  # before the next shape takes memory
            again = source in self._points
            points = self._points[source] if again else read()
            self._points[source] = points
            self._last = source, self._shape(prim, points, Notes() if again else self._notes)
        return self._last[1]

    def _shape(self, prim: object, both: Points, notes: Notes) -> Shape | None:
        """The shape of a mesh; None, with a note, if it has no points."""
        mesh, (points, before) = UsdGeom.Mesh(prim), both
        here = np.asarray(_now(points, self._clock), np.float32)
        if not len(here):
            if len(mesh.GetFaceVertexIndicesAttr().Get(self._clock.code) or ()):
                notes.add("a mesh without points is left out")
            return None
        faces = read_faces(mesh, len(here), self._clock, notes)
        surface = surface_of(faces, mesh, self._level(len(faces.sizes)), self._clock, notes)
        flipped = mesh.GetOrientationAttr().Get(self._clock.code) == "leftHanded"
        for attribute in (mesh.GetFaceVertexIndicesAttr(), mesh.GetFaceVertexCountsAttr()):
            if attribute.ValueMightBeTimeVarying():
                notes.add("a mesh whose faces change over time keeps them as at the scene's time")
                break
        rest = None if before is points else np.asarray(_now(before, self._clock), np.float32)
        begun = self._begun(surface, here)
        normals = None if surface.smooth else read_normals(prim, surface, self._clock, notes)
        return Shape(prim, points, surface, flipped, begun, rest, normals)

    def _begun(self, surface: DrawnPolygons, points: Array) -> Future[tuple[Array, Array | None]]:
        """Points of a surface; points of a smooth surface are computed in a thread."""
        if surface.smooth:
            return self._pool.submit(_quiet, surface, points)
        done: Future[tuple[Array, Array | None]] = Future()
        done.set_result(surface.points(points))
        return done

    def _level(self, faces: int) -> int:
        """Levels of subdivision for a mesh, so that all fit and each is smooth."""
        share = min(_DETAIL / max(self._count, 1), _MOST_FACES / max(faces, 1))
        return int(np.clip(np.log(max(share, 1)) / np.log(4), 1, _MOST_LEVELS))

    def _add(self, shape: Shape, choice: Choice, faces: NDArray[np.int64] | None) -> int | None:
        surface = shape.surface
        drawn = None if faces is None else np.isin(surface.face_ids, faces)
        if not len(surface.sizes) or not (drawn is None or drawn.any()):
            return None
        values = self._attributes(shape, choice)
        positions, normals = shape.begun.result()
        triangles, polygons = triangulate(surface.sizes, surface.vertices, positions)
        if drawn is not None:
            triangles = triangles[drawn[polygons]]
        first, index = weld(surface.vertices, *values.values())
        indices = index.astype(np.uint32)[triangles]
        if drawn is not None:  # else triangles use all corners
            indices, used = _packed(indices, len(first))
            first = first[used]
        if shape.flipped:
            indices = np.ascontiguousarray(indices[:, ::-1])
        origins = surface.vertices[first]
        given = {name: freeze_in_place(rows.take(first, axis=0)) for name, rows in values.items()}
        if normals is not None:
            turned = -normals if shape.flipped else normals
            given["normals"] = freeze_in_place(turned.take(origins, axis=0))
        points = freeze_in_place(positions.take(origins, axis=0))
        made = Vertices(points, **{n: given.get(n) for n in _ATTRIBUTES})
        return self._store(shape, made, freeze_in_place(indices), first)

    def _store(
        self, shape: Shape, made: Vertices, indices: NDArray[Any], first: NDArray[np.int64]
    ) -> int:
        origins = shape.surface.vertices[first]
        name = str(shape.prim.GetPath())
        given: dict[str, Any] = {n: getattr(made, n) for n in _ATTRIBUTES}
        points, turning = made.positions, shape.normals
        smooth, moves = shape.surface.smooth, is_dynamic(shape.points)
        moving: Any = shape.points
        motion: Dynamic | None = None
        steps: Dynamic | None = None
        if moves and smooth:
            motion = LimitOverTime(moving, shape.surface, origins, made, shape.flipped)
        elif moves:
            steps = ChosenOverTime(moving, origins)
        if shape.rest is not None and made.normals is not None and not smooth:
            rest = replace(made, positions=np.ascontiguousarray(shape.rest[origins]))
            if moves:
                points = rest.positions
            else:
                posed = PointCache(Composite(points), None, rest, indices.astype(np.uint32), name)
                given["normals"] = posed.at(self._clock.time).normals
        elif turning is not None and turning.moving is not None:
            assert turning.rows is not None
            given["normals"] = ChosenOverTime(turning.moving, turning.rows[first])
        try:
            return self._scene.add_mesh(
                points, indices, steps=steps, motion=motion, name=name, **given
            )
        except InputError as error:
            raise InputError(f"{self._clock.file}: {name}: {error}") from None

    def _attributes(self, shape: Shape, choice: Choice) -> Mapping[str, NDArray[Any]]:
        """Values at the corners of the polygons, by attribute of a mesh."""
        found: dict[str, NDArray[Any] | None] = {}
        if shape.normals is not None:
            found["normals"] = shape.normals.now
            found["alike"] = shape.normals.alike
        for attribute, name in zip(("uv", "uv1"), choice.uv_sets, strict=False):
            found[attribute] = _flipped(self._corners(shape, name, 2))
        if choice.colored:
            found["colors"] = self._colors(shape)
        return {name: array for name, array in found.items() if array is not None}

    def _corners(self, shape: Shape, name: str, columns: int) -> Array | None:
        primvar = read_primvar(shape.prim, name, columns, self._clock)
        if primvar is None:
            return None
        if primvar.interpolation == "vertex":
            shape.begun.result()  # it makes the maps that these values need, too
        found = shape.surface.corners(primvar)
        if found is None:
            note_length(name, self._notes)
        return found

    def _colors(self, shape: Shape) -> Array | None:
        color = self._corners(shape, "displayColor", 3)
        opacity = self._corners(shape, "displayOpacity", 1)
        if color is None:
            return None
        alpha = np.ones((len(color), 1), np.float32) if opacity is None else opacity
        return np.asarray(np.clip(np.concatenate([color, alpha], axis=1), 0, None), np.float32)


def _quiet(surface: DrawnPolygons, points: Array) -> tuple[Array, Array | None]:
    """Points of a surface; huge numbers may overflow in between, as in all of the reader."""
    with np.errstate(all="ignore"):
        return surface.points(points)


def _packed(indices: NDArray[Any], count: int) -> tuple[NDArray[Any], NDArray[np.int64]]:
    """Renumbers used vertices from 0; returns the new indices, and the used vertices."""
    seen = np.zeros(count, bool)
    seen[indices] = True
    return (np.cumsum(seen, dtype=np.uint32) - 1)[indices], np.flatnonzero(seen)


def _flipped(uv: Array | None) -> Array | None:
    """Moves the origin of texture coordinates from the bottom left to the top left."""
    if uv is not None:
        uv = uv.copy()
        np.subtract(1, uv[:, 1], out=uv[:, 1])
    return uv


def _now(points: Array | Dynamic, clock: Clock) -> Array:
    return points.at(clock.time) if is_dynamic(points) else points


def uv_names(wanted: Sequence[str], prim: object) -> tuple[str, ...]:
    """Primvars of texture coordinates: primvars that a material reads, or the first usual name."""
    if wanted:
        return tuple(wanted[:2])
    api = UsdGeom.PrimvarsAPI(prim)
    return tuple(name for name in USUAL_UV if api.HasPrimvar(name))[:1]
