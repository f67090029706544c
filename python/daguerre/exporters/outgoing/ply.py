"""Writes triangles as PLY, binary, little-endian.

Source: G. Turk, "The PLY Polygon File Format", 1994; names of texture coordinates as pbrt-v4 and
Mitsuba 3 read them (``u``, ``v``).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.compiled import __version__
from daguerre.scene.parts import Mesh

Array = NDArray[np.float32]
Triangles = NDArray[np.uint32]
Place = NDArray[np.float64]


def ply_bytes(mesh: Mesh, uv: Array | None, place: Place | None = None) -> bytes:
    """Makes the bytes of a file of a mesh.

    Args:
        mesh: Mesh with the positions, normals and triangles to write.
        uv: Texture coordinates, shape (N, 2), or None.
        place: World from mesh, shape (4, 4): the file is in world space, and its triangles
            keep their sides. None: in mesh space.
    """
    positions, normals, triangles = mesh.positions, mesh.normals, mesh.indices.reshape(-1, 3)
    if place is not None:
        positions, normals, triangles = _placed(positions, normals, triangles, place)
    columns: list[tuple[str, Array]] = [("x y z", positions)]
    if normals is not None:
        columns.append(("nx ny nz", normals))
    if uv is not None:
        columns.append(("u v", uv))
    names = " ".join(name for name, _ in columns).split()
    vertices = np.concatenate([np.asarray(v, "<f4") for _, v in columns], axis=1)
    faces = np.empty(len(triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = triangles
    lines = [
        "ply",
        "format binary_little_endian 1.0",
        f"comment Daguerre {__version__}",
        f"element vertex {len(vertices)}",
        *(f"property float {name}" for name in names),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header\n",
    ]
    return b"".join(["\n".join(lines).encode(), vertices.tobytes(), faces.tobytes()])


def _placed(
    positions: Array, normals: Array | None, triangles: Triangles, place: Place
) -> tuple[Array, Array | None, Triangles]:
    """Moves a mesh to its place; a mirror image has its corners in reverse order."""
    linear = place[:3, :3]
    moved = (positions @ linear.T + place[:3, 3]).astype(np.float32)
    if normals is not None:
        turned = normals @ np.linalg.inv(linear)
        length = np.linalg.norm(turned, axis=1, keepdims=True)
        normals = (turned / np.maximum(length, 1e-30)).astype(np.float32)
    return moved, normals, triangles[:, ::-1] if np.linalg.det(linear) < 0 else triangles
