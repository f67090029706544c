"""Meshes of polygons and subdivision surfaces, as triangles with values per vertex."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.checks import array, freeze_in_place, integers, short, to_numbers
from daguerre.errors import InputError
from daguerre.files.value import Value
from daguerre.motion.values import Dynamic

from .limits import check_coordinates
from .mesh import COLUMNS, mesh_of, with_alpha
from .motion import Vertices
from .parts import Mesh, vertices_of
from .polygons import check_sizes, triangulate, vertices_of_triangles, weld
from .subdivision import Refiner, Subdivision

IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Polygons:
    """Polygons with values, as a caller gave them.

    Attributes:
        positions: Positions of vertices at the time of the scene, shape (N, 3).
        sizes: Corners of each polygon, shape (F,).
        vertices: Vertex of each corner, shape (C,).
        values: Values per vertex (N, K) or per corner (C, K), or None, by name.
        where: Owner, for messages.
    """

    positions: NDArray[np.float32]
    sizes: IntArray
    vertices: IntArray
    values: Mapping[str, NDArray[Any] | None]
    where: str

    def corner_values(self) -> dict[str, NDArray[Any]]:
        """Values that are given per corner; per vertex wins where both fit."""
        corners, count = len(self.vertices), len(self.positions)
        return {
            key: value
            for key, value in self.values.items()
            if value is not None and value.shape[:1] == (corners,) and corners != count
        }


def polygons_of(
    positions: ArrayLike,
    indices: ArrayLike,
    sizes: ArrayLike | None,
    values: Mapping[str, Any],
    where: str,
) -> Polygons:
    """Checks polygons; without ``sizes`` all have as many corners as ``indices`` has columns.

    Raises:
        InputError: Numbers do not fit together.
    """
    points = array(positions, where, "positions", 3)
    check_coordinates(points, where)
    vertices = integers(indices, where, "indices", len(points))
    if sizes is None:
        columns = vertices.shape[1] if vertices.ndim == 2 else 3
        if columns < 3 or vertices.size % columns:
            raise InputError(
                f"{where}: indices: wanted shape (F, 3) or sizes, got {vertices.shape}"
            )
        each = np.full(vertices.size // columns, columns)
    else:
        each = integers(sizes, where, "sizes", 1 << 31).reshape(-1)
    check_sizes(each, vertices.size, where)
    named = {
        key: _checked(value, key, (len(points), vertices.size), where)
        for key, value in values.items()
    }
    return Polygons(points, each, vertices.reshape(-1), named, where)


def _checked(
    value: Any, key: str, counts: tuple[int, int], where: str
) -> NDArray[np.float32] | None:
    """Checks values per vertex or per corner; None stays None.

    Raises:
        InputError: A shape or a number is wrong.
    """
    given = with_alpha(value, where) if key == "colors" else value
    if given is None:
        return None
    found = array(given, where, key, COLUMNS[key])
    if len(found) not in counts:
        raise InputError(
            f"{where}: {key}: wanted {counts[0]} elements (one per vertex) or {counts[1]} (one "
            f"per corner), got {len(found)}"
        )
    return found


class Over(NamedTuple):
    """Values over time of a mesh: positions, normals, or all vertices; None: none."""

    positions: Dynamic | None
    normals: Dynamic | None
    vertices: Dynamic | None


def mesh_of_polygons(
    polygons: Polygons, over: Over, subdivision: Subdivision | str | None, name: str
) -> tuple[Mesh, Over]:
    """Makes a mesh of polygons or of their subdivision surface, and its values over time.

    Raises:
        InputError: Numbers do not fit together, or the surface has too many faces.
    """
    where = polygons.where
    if over.vertices is not None:
        raise InputError(f"{where}: motion: wanted positions over time, as these are polygons")
    if subdivision is None:
        return _triangles_of(polygons, over, name)
    if isinstance(subdivision, str):
        subdivision = Subdivision(subdivision)
    if not isinstance(subdivision, Subdivision):
        raise InputError(
            f"{where}: subdivision: wanted a name or a Subdivision, got {short(subdivision)}"
        )
    mesh, surface = _surface_of(polygons, over.positions, subdivision, name)
    return mesh, Over(None, None, surface)


def _triangles_of(polygons: Polygons, over: Over, name: str) -> tuple[Mesh, Over]:
    """Makes a mesh of polygons; vertices become several where values per corner differ."""
    where, count = polygons.where, len(polygons.positions)
    given = polygons.corner_values()
    if not given:
        triangles = vertices_of_triangles(polygons.sizes, polygons.vertices, polygons.positions)
        return mesh_of(polygons.positions, triangles, polygons.values, where, name), over
    corners, _ = triangulate(polygons.sizes, polygons.vertices, polygons.positions)
    apart = "normals" in given and over.normals is not None  # equal now, not at other times
    every = [np.arange(len(polygons.vertices))] if apart else []
    leaders, index = weld(polygons.vertices, *given.values(), *every)
    source = polygons.vertices[leaders]
    values = {
        key: None if value is None else value[leaders if key in given else source]
        for key, value in polygons.values.items()
    }
    mesh = mesh_of(polygons.positions[source], index[corners], values, where, name)
    positions = over.positions and Picked(over.positions, source, count, where)
    normals = over.normals
    if normals is not None:
        per_corner = "normals" in given
        of = len(polygons.vertices) if per_corner else count
        normals = Picked(normals, leaders if per_corner else source, of, where)
    return mesh, Over(positions, normals, None)


@dataclass(frozen=True, eq=False)
class Picked(Value):
    """Vertices of a value over time: its rows, some of them several times.

    Attributes:
        value: Shape (N, K) at a time.
        rows: Shape (M,).
        count: N.
        where: Owner, for messages.
    """

    value: Dynamic
    rows: IntArray
    count: int
    where: str

    def at(self, time_s: float) -> NDArray[Any]:
        """Rows at a time, s.

        Raises:
            InputError: The number of vertices changes.
        """
        found = to_numbers(self.value.at(time_s), self.where, "positions", "shape (N, 3)")
        if found.ndim != 2 or len(found) != self.count:
            raise InputError(
                f"{self.where}: positions: wanted {self.count} elements, got {found.shape}"
            )
        return found[self.rows]

    def breaks(self, begin: float, end: float) -> Sequence[float] | NDArray[np.float64]:
        """Breaks of the value, s."""
        return self.value.breaks(begin, end)


@dataclass(frozen=True, eq=False)
class SurfaceOverTime(Value):
    """The vertices of a subdivision surface with control points that move.

    Attributes:
        positions: Control points over time, shape (N, 3), m.
        refiner: The surface.
        rows: Refined vertex of each vertex of the mesh, shape (M,).
        rest: Vertices at the time of the scene.
    """

    positions: Dynamic
    refiner: Refiner
    rows: IntArray
    rest: Vertices

    def at(self, time_s: float) -> Vertices:
        """Vertices at a time, s."""
        points, normals = self.refiner.surface(self.positions.at(time_s))
        return replace(
            self.rest,
            positions=_single(points[self.rows]),
            normals=_single(normals[self.rows]),
        )

    def breaks(self, begin: float, end: float) -> Sequence[float] | NDArray[np.float64]:
        """Breaks of the control points, s."""
        return self.positions.breaks(begin, end)


def _surface_of(
    polygons: Polygons, moving: Dynamic | None, subdivision: Subdivision, name: str
) -> tuple[Mesh, SurfaceOverTime | None]:
    """Makes a mesh of a subdivision surface, and its vertices over time if it moves.

    Values per vertex follow the rule of positions, values per corner the rule of seams.

    Raises:
        InputError: Numbers do not fit together, or the surface has too many faces.
    """
    where = polygons.where
    for key in ("normals", "tangents"):
        if polygons.values[key] is not None:
            raise InputError(f"{where}: {key}: not allowed, a subdivision surface has its own")
    refiner = Refiner(
        len(polygons.positions), polygons.sizes, polygons.vertices,
        subdivision.scheme, subdivision.level, subdivision.rules, where,
    )  # fmt: skip
    points, normals = refiner.surface(polygons.positions)
    corners, _ = triangulate(refiner.sizes, refiner.vertices, points)
    per_corner = {
        key: _single(refiner.face_varying(value)) for key, value in polygons.corner_values().items()
    }
    rows, index = np.arange(refiner.count), refiner.vertices
    if per_corner:
        leaders, index = weld(refiner.vertices, *per_corner.values())
        rows = refiner.vertices[leaders]
        per_corner = {key: value[leaders] for key, value in per_corner.items()}
    values: dict[str, Any] = {"normals": _single(normals[rows]), "tangents": None}
    for key in ("uv", "uv1", "colors"):
        given = polygons.values[key]
        values[key] = per_corner[key] if key in per_corner else _at(refiner, given, rows)
    mesh = mesh_of(_single(points[rows]), index[corners], values, where, name)
    over = None if moving is None else SurfaceOverTime(moving, refiner, rows, vertices_of(mesh))
    return mesh, over


def _at(
    refiner: Refiner, value: NDArray[np.float32] | None, rows: IntArray
) -> NDArray[np.float32] | None:
    return None if value is None else _single(refiner.vertex(value)[rows])


def _single(values: NDArray[Any]) -> NDArray[np.float32]:
    return freeze_in_place(values.astype(np.float32))
