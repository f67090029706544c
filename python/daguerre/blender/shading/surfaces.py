"""Geometry of the faces of a mesh that have one material, as patterns need it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.blender.arrays import read
from daguerre.blender.atlas import unwrapped

if TYPE_CHECKING:
    import bpy


Array = NDArray[Any]
#: Name of texture coordinates that are made for patterns; no layer has it.
ATLAS = "\natlas"


@dataclass
class MaterialFaces:
    """Faces of a mesh that have one material.

    Attributes:
        mesh: ``bpy.types.Mesh``, evaluated.
        points: Positions of all vertices, shape (N, 3).
        vertices: Vertex of each corner, shape (C,).
        triangles: Corners of the triangles of these faces, shape (T, 3).
        faces: Face of each of these triangles, shape (T,).
        world: World from mesh in Blender's frame, shape (4, 4).
        flat: Whether maps do not overlap themselves, by name, as far as that is known.
    """

    mesh: bpy.types.Mesh
    points: Array
    vertices: Array
    triangles: Array
    faces: Array
    world: Array
    flat: dict[str, bool] = field(default_factory=dict)
    _atlas: list[Array] = field(default_factory=list)

    def uv(self, primvar: str) -> Array:
        """Texture coordinates at corners of triangles, shape (T, 3, 2); zeros if there are none."""
        found = self.layer(primvar)
        if found is None:
            return np.zeros((len(self.triangles), 3, 2))
        return found[self.triangles]

    def uv_areas(self, primvar: str) -> Array:
        """Twice the area of each triangle in texture coordinates, shape (T,)."""
        corners = self.uv(primvar).astype(np.float64)
        sides = corners[:, 1:] - corners[:, :1]
        return np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])

    def layer(self, primvar: str) -> Array | None:
        """Texture coordinates of all corners, shape (C, 2); None: there are none.

        A name that no layer can have is the map that renders use, or the atlas.
        """
        if primvar == ATLAS:
            return self.atlas()
        layers = self.mesh.uv_layers
        if primvar.startswith("\n") or not primvar:
            layer = next((one for one in layers if one.active_render), None)
        else:
            layer = layers.get(primvar)
        return None if layer is None else read(layer.uv, "vector", 2, np.float32)

    def atlas(self) -> Array:
        """Texture coordinates of all corners without overlap, shape (C, 2), made once."""
        if not self._atlas:
            placed = unwrapped(self.points, self.vertices[self.triangles], self.faces)
            found = np.zeros((len(self.vertices), 2), np.float32)
            found[self.triangles] = placed
            self._atlas.append(found)
        return self._atlas[0]

    def vector(self, name: str) -> Array | None:
        """Coordinates at corners of triangles, shape (T, 3, 3), in Blender's frame.

        Args:
            name: "Generated", "Object" or "Position"; others give None.
        """
        rows = self.vertices[self.triangles]
        if name == "Object":
            return np.asarray(self.points[rows])
        if name == "Position":
            return np.asarray(self.points[rows] @ self.world[:3, :3].T + self.world[:3, 3])
        if name == "Generated":
            return np.asarray(self._generated()[rows])
        return None

    def _generated(self) -> Array:
        """Places of vertices before they are deformed, in the texture space of the mesh."""
        points = self._undeformed().astype(np.float64)
        size = np.array(self.mesh.texspace_size, np.float64)
        low = np.array(self.mesh.texspace_location, np.float64) - size
        return np.asarray((points - low) / np.where(size > 0, 2 * size, 1))

    def _undeformed(self) -> Array:
        """Places of vertices before they are deformed; outside of renders without modifiers."""
        keys = self.mesh.shape_keys
        if keys is not None and len(keys.reference_key.data) == len(self.mesh.vertices):
            return read(keys.reference_key.data, "co", 3, np.float32)
        return read(self.mesh.vertices, "undeformed_co", 3, np.float32)

    def length(self, primvar: str) -> float | None:
        """Length in units of the scene of one unit of texture coordinates; None: no area."""
        x, y, z = (np.linalg.norm(self.world[:3, i]) for i in range(3))
        corners = self.points[self.vertices[self.triangles]].astype(np.float64)
        sides = corners[:, 1:] - corners[:, :1]
        space = float(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum())
        plane = float(self.uv_areas(primvar).sum())
        if not space > 0 or not plane > 0:
            return None
        return float((space / plane) ** 0.5 * abs(x * y * z) ** (1 / 3))
