"""Meshes of a scene as PLY files: one file for each use of a mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.scene.parts import Mesh
from daguerre.scene.scene import Scene

from .folder import OutgoingFolder
from .ply import Place, ply_bytes
from .surfaces import ExportedMaterial


class MeshFiles:
    """PLY files of a scene's meshes.

    Attributes:
        notes: Remarks.
    """

    def __init__(self, scene: Scene, folder: OutgoingFolder, notes: Notes, *, v_up: bool) -> None:
        """Takes a scene.

        Args:
            scene: The scene.
            folder: Folder for the files.
            notes: Remarks.
            v_up: Whether texture coordinates have v up, as pbrt has them; they are mirrored then.
        """
        self._scene, self._folder, self.notes = scene, folder, notes
        self._v_up = v_up
        self._known: dict[tuple[int, int, bytes], str] = {}

    def path(self, index: int, look: ExportedMaterial, place: Place | None = None) -> str:
        """Path of a mesh for a material, relative to the scene file.

        Args:
            index: Index of the mesh.
            look: The material.
            place: World from mesh, shape (4, 4), if the file is to be in the world.
        """
        mesh = self._scene.meshes[index]
        if look.vertex_colors and mesh.colors is not None and bool((mesh.colors != 1).any()):
            self.notes.add("vertex colours of a mesh are left out")
        key = index, look.uv_set, b"" if place is None else place.tobytes()
        if key not in self._known:
            data = ply_bytes(mesh, self._uv(mesh, look.uv_set), place)
            self._known[key] = self._folder.add("mesh", ".ply", data)
        return self._known[key]

    def has_normals(self, index: int) -> bool:
        """Whether a mesh has normals; without, its triangles are flat."""
        return self._scene.meshes[index].normals is not None

    def _uv(self, mesh: Mesh, uv_set: int) -> NDArray[np.float32] | None:
        uv = mesh.uv1 if uv_set else mesh.uv
        if uv is None or not self._v_up:
            return uv
        return np.asarray(np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1), np.float32)
