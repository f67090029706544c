"""Shapes as meshes with Mitsuba's texture coordinates, in the space that ``to_world`` transforms.

Source: Mitsuba 3, documentation of shapes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from daguerre.scene import shapes
from daguerre.scene.shapes import SQUARE, ShapeMesh

from .node import Node
from .transforms import frame, mirrors

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PrimitiveMesh:
    """Mesh of a sphere, rectangle, disk, cylinder or cube.

    Attributes:
        mesh: The shape of unit size.
        inner: Transform by the shape's parameters, such as centre and radius; ``to_world`` follows.
    """

    mesh: ShapeMesh
    inner: Array


def primitive_mesh(node: Node) -> PrimitiveMesh | None:
    """Mesh of a shape that its parameters describe; None: the plugin is no such shape.

    Raises:
        InputError: A parameter is wrong.
    """
    make = _PRIMITIVES.get(node.plugin)
    if make is None:
        return None
    made = make(node)
    return replace(made, mesh=made.mesh.flipped()) if inward(node) else made


def inward(node: Node) -> bool:
    """Whether the normals of a shape point inward: Mitsuba's normals of a mirrored sphere do."""
    flipped = node.flag("flip_normals", False)
    return flipped != (node.plugin == "sphere" and mirrors(node.transform()))


def _mesh(found: ShapeMesh | None) -> ShapeMesh:
    assert found is not None  # of unit size
    return found


@cache
def _unit_sphere() -> ShapeMesh:
    return _mesh(shapes.sphere())


def _sphere(node: Node) -> PrimitiveMesh:
    """Sphere; u from +x toward +y, v from +z down."""
    inner = np.diag([*[node.number("radius", 1.0, above=0)] * 3, 1.0])
    inner[:3, 3] = node.vector("center", (0, 0, 0))
    return PrimitiveMesh(_unit_sphere(), inner)


def _rectangle(node: Node) -> PrimitiveMesh:
    return PrimitiveMesh(_v_up(_mesh(shapes.rectangle())), np.eye(4))


def _disk(node: Node) -> PrimitiveMesh:
    """Disk; u from the centre to the rim, v around."""
    mesh = _mesh(shapes.disk())
    return PrimitiveMesh(replace(mesh, uv=mesh.uv[:, ::-1]), np.eye(4))


def _cylinder(node: Node) -> PrimitiveMesh:
    """From p0 to p1; u around, v along."""
    begin, end = node.vector("p0", (0, 0, 0)), node.vector("p1", (0, 0, 1))
    radius = node.number("radius", 1.0, above=0)
    length = float(np.linalg.norm(end - begin))
    if not length > 0:
        node.fail("the two points must differ")
    inner = np.eye(4)
    inner[:3, :3] = frame((end - begin) / length) * (radius, radius, length)
    inner[:3, 3] = begin
    return PrimitiveMesh(_v_up(_mesh(shapes.cylinder(low=0.0, high=1.0))), inner)


def _cube(node: Node) -> PrimitiveMesh:
    """Six squares, each with a whole picture."""
    corners = np.array(_CUBE, float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    uv = SQUARE * (0.5, -0.5) + 0.5
    return PrimitiveMesh(_mesh(shapes.quads(corners, normals, uv)), np.eye(4))


def _v_up(mesh: ShapeMesh) -> ShapeMesh:
    """The same mesh with v flipped."""
    return replace(mesh, uv=mesh.uv * (1, -1) + (0, 1))


#: Corners of the faces of a cube, each with the lower left of a picture first.
_CUBE = [
    [(1, -1, -1), (1, -1, 1), (-1, -1, 1), (-1, -1, -1)],
    [(1, 1, -1), (-1, 1, -1), (-1, 1, 1), (1, 1, 1)],
    [(1, -1, -1), (1, 1, -1), (1, 1, 1), (1, -1, 1)],
    [(1, -1, 1), (1, 1, 1), (-1, 1, 1), (-1, -1, 1)],
    [(-1, -1, 1), (-1, 1, 1), (-1, 1, -1), (-1, -1, -1)],
    [(1, 1, -1), (1, -1, -1), (-1, -1, -1), (-1, 1, -1)],
]
_PRIMITIVES: dict[str, Callable[[Node], PrimitiveMesh]] = {
    "sphere": _sphere,
    "rectangle": _rectangle,
    "disk": _disk,
    "cylinder": _cylinder,
    "cube": _cube,
}
