"""Meshes from arrays, with checks, and the keywords of ``Scene.add_mesh``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.checks import array, as_readonly, freeze_in_place, optional_array, to_numbers
from daguerre.errors import InputError
from daguerre.motion.values import Dynamic
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table

from .far import ZERO
from .limits import check_coordinates
from .parts import Mesh

if TYPE_CHECKING:
    from .subdivision.rules import Subdivision

#: Number of components of each vertex attribute.
COLUMNS = {"normals": 3, "uv": 2, "uv1": 2, "tangents": 4, "colors": 4}


class MeshKeywords(TypedDict, total=False):
    """Keywords of ``Scene.add_mesh``."""

    uv1: ArrayLike | None
    tangents: ArrayLike | None
    colors: ArrayLike | None
    steps: Dynamic | tuple[ArrayLike, ArrayLike] | None
    motion: Dynamic | None
    sizes: ArrayLike | None
    subdivision: Subdivision | str | None
    name: str


# fmt: off
MESH = Table(
    Parameter("uv1", "Texture coordinates, set 1", kind="value"),
    Parameter("tangents", "Tangents, shape (N, 4), w is the handedness", kind="value"),
    Parameter(
        "colors", "Vertex colors, linear RGB or RGBA, shape (N, 3) or (N, 4)", kind="value",
    ),
    Parameter(
        "steps", "Vertices over time: (times (S,) in s, positions (S, N, 3)) or a value over time; "
        "``positions`` then are those to which the normals belong", kind="value",
    ),
    Parameter(
        "motion", "All vertices over time", kind="value",
        in_python="All vertices over time, as :class:`daguerre.scene.motion.Vertices`; the arrays "
        "then are those of the scene's time.",
    ),
    Parameter(
        "sizes", "Corners of each polygon, shape (F,)", kind="value",
        in_python="Corners of each polygon, shape (F,); ``indices`` then has shape (C,), C their "
        "sum, and values may stand per corner, with C rows. Default: triangles.",
    ),
    Parameter(
        "subdivision", "Subdivision surface of the polygons", kind="value",
        in_python='Subdivision surface of the polygons: "catmull-clark", "loop", "bilinear", or '
        "a :class:`daguerre.scene.subdivision.Subdivision` with level and rules. Values per vertex "
        "follow it; without ``sizes`` each polygon has as many corners as ``indices`` has columns.",
    ),
    Parameter("name", "For messages", default="", kind="text"),
)
# fmt: on


def mesh_of(
    positions: ArrayLike, indices: ArrayLike, attributes: Mapping[str, Any], where: str, name: str
) -> Mesh:
    """Makes a mesh from arrays; ``attributes`` are those in ``COLUMNS``, or None.

    Raises:
        InputError: A shape, an index or a number is wrong; the message names it.
    """
    points = array(positions, where, "positions", 3)
    check_coordinates(points, where)
    triangles = as_readonly(_triangles(indices, where, len(points)), np.uint32)
    given = {**attributes, "colors": with_alpha(attributes["colors"], where)}
    made = {
        key: optional_array(given[key], where, key, columns, len(points))
        for key, columns in COLUMNS.items()
    }
    return Mesh(points, triangles, **made, name=name, origin=ZERO)


def _triangles(indices: ArrayLike, where: str, count: int) -> NDArray[Any]:
    """Checks indices against the number of vertices; shape (M, 3)."""
    triangles = to_numbers(indices, where, "indices", "shape (M, 3)")
    if triangles.dtype.kind not in "iu":
        raise InputError(f"{where}: indices: wanted integers, got {triangles.dtype}")
    if triangles.size % 3:
        raise InputError(f"{where}: indices: wanted a multiple of 3, got {triangles.size}")
    if triangles.ndim != 1 and triangles.shape[1:] != (3,):
        raise InputError(f"{where}: indices: wanted shape (M, 3), got {triangles.shape}")
    triangles = triangles.reshape(-1, 3)
    if triangles.size and (triangles.min() < 0 or triangles.max() >= count):
        raise InputError(
            f"{where}: indices: wanted 0 .. {count - 1}, got {triangles.min()} .. {triangles.max()}"
        )
    return triangles


def with_alpha(colors: ArrayLike | None, where: str) -> ArrayLike | None:
    """Adds an opaque alpha to colors that have none."""
    if colors is None:
        return None
    if to_numbers(colors, where, "colors", "shape (N, 3) or (N, 4)").shape[-1:] != (3,):
        return colors
    rgb = array(colors, where, "colors", 3)
    return freeze_in_place(np.concatenate([rgb, np.ones((len(rgb), 1), np.float32)], axis=1))
