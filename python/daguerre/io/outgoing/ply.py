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


def ply_bytes(mesh: Mesh, uv: Array | None, *, reversed: bool) -> bytes:
    """Makes the bytes of a file of a mesh in its own space.

    Args:
        mesh: Mesh, whose positions, normals and triangles are written.
        uv: Texture coordinates, shape (N, 2), or None.
        reversed: Whether triangles run the other way round, for a mirrored placement that only
            winding tells; normals stay.
    """
    columns: list[tuple[str, Array]] = [("x y z", mesh.positions)]
    if mesh.normals is not None:
        columns.append(("nx ny nz", mesh.normals))
    if uv is not None:
        columns.append(("u v", uv))
    names = " ".join(name for name, _ in columns).split()
    vertices = np.concatenate([np.asarray(v, "<f4") for _, v in columns], axis=1)
    triangles = mesh.indices.reshape(-1, 3)
    faces = np.empty(len(triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = triangles[:, ::-1] if reversed else triangles
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
