"""Meshes of files: ``obj``, ``ply`` and ``serialized``, each read once for all shapes that use it.

Source: Mitsuba 3, documentation of these shapes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import asked_by
from daguerre.importers.meshes import obj, ply, serialized
from daguerre.importers.meshes.file_mesh import FileMesh

from .context import Context
from .node import Node
from .vertex_normals import lie_against, vertex_normals

FILES = ("obj", "ply", "serialized")
MISSING_MESH = "a mesh whose file is missing is left out"
#: Attributes that become colours of the mesh.
_COLORS = ("vertex_color", "face_color")


@dataclass(frozen=True)
class Wanted:
    """Request for a mesh of a file.

    Attributes:
        file: The file.
        plugin: Format of the file.
        number: Mesh of a file with several.
        flat: Whether faces are flat, without vertex normals.
        upside_down: Whether v is flipped.
        inside_out: Whether the front is flipped.
        attribute: Attribute with the vertex colours, or empty.
    """

    file: Path
    plugin: str
    number: int
    flat: bool
    upside_down: bool
    inside_out: bool
    attribute: str


class MeshFiles:
    """Meshes of the files of a scene.

    Without normals in the file they are means over the faces around; a serialized mesh without
    them has flat faces.

    Args:
        context: File, scene and notes.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._known: dict[Wanted, int] = {}

    def mesh(self, node: Node, attribute: str) -> int | None:
        """Index of the mesh of a shape; None, and a note: its file is missing.

        Raises:
            InputError: The file is wrong; the message names it.
        """
        name = node.text("filename")
        file = self._context.document.files_of(node).find(name, node.entry)
        wanted = Wanted(
            file=file or Path(name),
            plugin=node.plugin,
            number=node.whole("shape_index", 0, 0, 1 << 30),
            flat=node.flag("face_normals", False),
            upside_down=node.flag("flip_tex_coords", node.plugin == "obj"),
            inside_out=node.flag("flip_normals", False),
            attribute=attribute if attribute in _COLORS else "",
        )
        if attribute and not wanted.attribute:
            self._context.notes.add(f"the attribute {attribute[:40]!r} of a mesh is left out")
        if file is None:
            self._context.notes.add(MISSING_MESH, name=name)
            return None
        if wanted not in self._known:
            with asked_by(node.entry):
                self._known[wanted] = self._add(self._read(wanted), wanted)
        return self._known[wanted]

    def _read(self, wanted: Wanted) -> FileMesh:
        if wanted.plugin == "ply":
            return ply.read(wanted.file, self._context.notes)
        if wanted.plugin == "obj":
            return obj.read(wanted.file, self._context.notes)
        return serialized.read(wanted.file, wanted.number)

    def _add(self, mesh: FileMesh, wanted: Wanted) -> int:
        if wanted.flat:
            mesh = replace(mesh, normals=None)
        elif mesh.normals is None and wanted.plugin != "serialized":
            made = vertex_normals(mesh.positions, mesh.corners, mesh.sizes)
            mesh = replace(mesh, normals=made)
        elif mesh.normals is not None:
            mesh = along_normals(mesh, mesh.normals)
        if wanted.upside_down and mesh.uv is not None:
            mesh = replace(mesh, uv=(mesh.uv * (1, -1) + (0, 1)).astype(np.float32))
        if wanted.inside_out:
            mesh = inside_out(mesh)
        if wanted.attribute == "face_color":
            mesh = colored_by_faces(mesh)
        name = wanted.file.name
        return mesh.add_to(self._context.scene, name, colors=bool(wanted.attribute))


def colored_by_faces(mesh: FileMesh) -> FileMesh:
    """The mesh with the colours of its faces at their corners."""
    faces = len(mesh.corners) // 3 if mesh.sizes is None else len(mesh.sizes)
    sizes = np.full(faces, 3, np.uint32) if mesh.sizes is None else mesh.sizes
    colors = mesh.face_colors
    if colors is None:
        return replace(mesh, sizes=sizes, colors=None)
    return replace(mesh, sizes=sizes, colors=np.repeat(colors, sizes, axis=0), face_colors=None)


def along_normals(mesh: FileMesh, normals: NDArray[np.float32]) -> FileMesh:
    """Flips faces to agree with the normals, which decide the front in Mitsuba."""
    if not lie_against(mesh.positions, mesh.corners, mesh.sizes, normals):
        return mesh
    turned = inside_out(mesh)
    assert turned.normals is not None
    return replace(turned, normals=-turned.normals)


def inside_out(mesh: FileMesh) -> FileMesh:
    """The same mesh that faces the other side: each face has its corners in reverse order."""
    count = len(mesh.corners)
    if mesh.sizes is None:
        order = np.arange(count).reshape(-1, 3)[:, ::-1].reshape(-1)
    else:
        ends = np.repeat(np.cumsum(mesh.sizes.astype(np.int64)), mesh.sizes)
        begins = ends - np.repeat(mesh.sizes.astype(np.int64), mesh.sizes)
        order = begins + ends - 1 - np.arange(count)
    distinct = count != len(mesh.positions)
    by_corner = {
        key: value[order]
        for key in ("normals", "uv", "colors")
        if (value := getattr(mesh, key)) is not None and distinct and len(value) == count
    }
    turned = replace(mesh, corners=mesh.corners[order], **by_corner)
    return turned if turned.normals is None else replace(turned, normals=-turned.normals)
