"""Placed meshes as shapes of Mitsuba: alone, or as instances of a group."""

from __future__ import annotations

import numpy as np

from daguerre.io.outgoing.media import absorption
from daguerre.io.outgoing.meshes import MeshFiles
from daguerre.io.outgoing.placing import Placed, mirrored
from daguerre.io.outgoing.surfaces import Absorption, Emission, Look

from .writer_bsdfs import Bsdfs
from .writer_xml import Element, add, add_matrix, add_rgb, add_value


#: Least absorption, 1/m, of a medium.
_LEAST = 1e-9


class Shapes:
    """Shapes of a file.

    Attributes:
        absorbing: Whether one of them is filled with an absorbing medium.
    """

    def __init__(self, root: Element, looks: list[Look], bsdfs: Bsdfs, meshes: MeshFiles) -> None:
        self._root, self._looks, self._bsdfs, self._meshes = root, looks, bsdfs, meshes
        self.absorbing = False
        self._groups = 0

    def add(self, placed: Placed) -> None:
        """Adds a mesh at all of its places.

        Mitsuba has no instances of emitters, and takes the sides of a mirrored mesh from its
        corners, which are turned round for it.
        """
        look = self._looks[placed.material]
        if len(placed.transforms) > 1 and not look.emission.present:
            self._add_group(placed)
            return
        for transform in placed.transforms:
            shape = self._add_mesh(self._root, placed, reversed=mirrored(transform))
            if not np.array_equal(transform, np.eye(4)):
                add_matrix(shape, "to_world", transform)

    def _add_group(self, placed: Placed) -> None:
        name = f"group-{self._groups}"
        self._groups += 1
        self._bsdfs.id_of(placed.material, self._looks[placed.material])  # before its use
        group = add(self._root, "shape", type="shapegroup", id=name)
        self._add_mesh(group, placed, reversed=False)
        for transform in placed.transforms:
            instance = add(self._root, "shape", type="instance")
            add(instance, "ref", id=name)
            add_matrix(instance, "to_world", transform)

    def _add_mesh(self, parent: Element, placed: Placed, *, reversed: bool) -> Element:
        look = self._looks[placed.material]
        bsdf = self._bsdfs.id_of(placed.material, look)
        shape = add(parent, "shape", type="ply")
        path = self._meshes.path(placed.mesh, look, reversed=reversed)
        add_value(shape, "string", "filename", path)
        if not self._meshes.has_normals(placed.mesh):
            add_value(shape, "boolean", "face_normals", True)
        add(shape, "ref", id=bsdf)
        if look.emission.present:
            self._add_emission(shape, look.emission)
        if look.inside is not None:
            self._add_inside(shape, look.inside)
        return shape

    def _add_emission(self, shape: Element, emission: Emission) -> None:
        if emission.both_sides:
            self._meshes.notes.add("mesh that shines to both sides shines from its front alone")
        emitter = add(shape, "emitter", type="area")
        self._bsdfs.values.color(emitter, "radiance", emission.color)

    def _add_inside(self, shape: Element, inside: Absorption) -> None:
        """Adds the absorption of KHR_materials_volume: color^(x / distance)."""
        self.absorbing = True
        medium = add(shape, "medium", type="homogeneous", name="interior")
        # A colour may be no more than 1, and ``scale`` multiplies it.
        per_metre = absorption(inside)
        most = max(*per_metre, _LEAST)
        add_rgb(medium, "sigma_t", [value / most for value in per_metre])
        add_value(medium, "float", "scale", most)
        add_rgb(medium, "albedo", (0.0, 0.0, 0.0))
