"""Placed meshes as shapes of Mitsuba: alone, or as instances of a group."""

from __future__ import annotations

import numpy as np

from daguerre.exporters.outgoing.meshes import MeshFiles
from daguerre.exporters.outgoing.placing import Placed, mirrored
from daguerre.exporters.outgoing.ply import Place
from daguerre.exporters.outgoing.surfaces import Emission, ExportedMaterial

from .bsdfs import Bsdfs
from .media import Media
from .scene_xml import Element, add, add_matrix, add_value


class Shapes:
    """Shapes of a file."""

    def __init__(
        self,
        root: Element,
        looks: list[ExportedMaterial],
        bsdfs: Bsdfs,
        meshes: MeshFiles,
        media: Media,
    ) -> None:
        self._root, self._looks, self._bsdfs, self._meshes = root, looks, bsdfs, meshes
        self._media = media
        self._groups = 0

    def add(self, placed: Placed) -> None:
        """Adds a mesh at all of its places.

        Mitsuba has no instances of emitters. Its versions disagree on the sides of a mesh with a
        mirroring transform, so the file of such a mesh is in world space.
        """
        look = self._looks[placed.material]
        self._bsdfs.id_of(placed.material, look)  # defined before its use
        if len(placed.transforms) > 1 and not look.emission.present:
            self._add_group(placed)
            return
        for transform in placed.transforms:
            baked = transform if mirrored(transform) else None
            shape = self._add_mesh(self._root, placed, baked)
            if baked is None and not np.array_equal(transform, np.eye(4)):
                add_matrix(shape, "to_world", transform)

    def _add_group(self, placed: Placed) -> None:
        name = f"group-{self._groups}"
        self._groups += 1
        group = add(self._root, "shape", type="shapegroup", id=name)
        self._add_mesh(group, placed)
        for transform in placed.transforms:
            instance = add(self._root, "shape", type="instance")
            add(instance, "ref", id=name)
            add_matrix(instance, "to_world", transform)

    def _add_mesh(self, parent: Element, placed: Placed, baked: Place | None = None) -> Element:
        look = self._looks[placed.material]
        shape = add(parent, "shape", type="ply")
        path = self._meshes.path(placed.mesh, look, baked)
        add_value(shape, "string", "filename", path)
        if not self._meshes.has_normals(placed.mesh):
            add_value(shape, "boolean", "face_normals", True)
        add(shape, "ref", id=self._bsdfs.id_of(placed.material, look))
        if look.emission.present:
            self._add_emission(shape, look.emission)
        self._media.add_sides(shape, look)
        return shape

    def _add_emission(self, shape: Element, emission: Emission) -> None:
        if emission.both_sides:
            self._meshes.notes.add("mesh that emits on both sides emits on its front only")
        emitter = add(shape, "emitter", type="area")
        self._bsdfs.values.color(emitter, "radiance", emission.color)
