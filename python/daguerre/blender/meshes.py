"""Reads evaluated meshes: one mesh of the scene for each material, shared by all copies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.files.notes import Notes
from daguerre.scene.limits import check_size
from daguerre.scene.polygons import weld
from daguerre.scene.scene import Scene

from .arrays import attribute, points_of, read
from .shading.surfaces import MaterialFaces

if TYPE_CHECKING:
    import bpy


Matrix = NDArray[np.float64]
#: Times (S,) in s, and points of all vertices at each, shape (S, N, 3).


class Steps(NamedTuple):
    """Points over time.

    Attributes:
        times: Times, s, shape (S,).
        points: Points at those times, shape (S, N, 3).
    """

    times: Sequence[float]
    points: NDArray[np.float32]

    def of(self, rows: NDArray[np.integer]) -> Steps:
        """Some of the points."""
        return Steps(self.times, self.points[:, rows])


Parts = list[tuple[int, int]]
#: Mesh, slot, and the material that was made for the mesh; None: the slot's material.
Added = list[tuple[int, int, int | None]]


_STILL = np.eye(4)


class Needs(NamedTuple):
    """Layers of a mesh that a material reads, by name.

    Attributes:
        uv: UV maps of texture coordinates 0 and 1; "": the active render map.
        color: Colour attribute that tints the material; "": the active render attribute; None: no
            attribute.
    """

    uv: tuple[str, ...] = ("",)
    color: str | None = None


class Materials(Protocol):
    """Materials of the scene."""

    def index(self, material: bpy.types.Material | None) -> int:
        """Index in the scene of a ``bpy.types.Material``; None: the default."""

    def needs(self, material: bpy.types.Material | None) -> Needs:
        """Layers of a mesh that a material reads."""

    def binding(self, material: bpy.types.Material | None, world: Matrix) -> Any | None:
        """Key of a material's dependencies besides the mesh; None: it is the same on all."""

    def painted(
        self, material: bpy.types.Material | None, surface: MaterialFaces
    ) -> tuple[int, Needs]:
        """Index of a material that is made for a surface, and layers that it reads."""


def slots_of(thing: bpy.types.Object) -> tuple[Any, ...]:
    """Materials of an object, by slot; at least one, which may be None."""
    return tuple(slot.material for slot in thing.material_slots) or (None,)


@dataclass(frozen=True)
class MeshArrays:
    """The arrays of a Blender mesh.

    Attributes:
        mesh: ``bpy.types.Mesh``, evaluated.
        points: Shape (N, 3).
        vertices: Vertex of each corner, shape (C,).
        triangles: Corners of each triangle, shape (T, 3).
        slots: Material slot of each triangle, shape (T,).
        faces: Face of each triangle, shape (T,).
        normals: Unit normals of corners, shape (C, 3); None: the mesh is flat.
    """

    mesh: bpy.types.Mesh
    points: NDArray[np.float32]
    vertices: NDArray[np.int32]
    triangles: NDArray[np.int32]
    slots: NDArray[np.int32]
    faces: NDArray[np.int32]
    normals: NDArray[np.float32] | None


def source_of(mesh: bpy.types.Mesh, slots: int) -> MeshArrays:
    """Reads a mesh.

    Args:
        mesh: ``bpy.types.Mesh``, evaluated.
        slots: Number of material slots; faces with a later slot have the last.
    """
    mesh.calc_loop_triangles()
    triangles = read(mesh.loop_triangles, "loops", 3, np.uint32).view(np.int32)
    vertices = attribute(mesh, ".corner_vert")
    if vertices is None:
        vertices = np.zeros(0, np.int32)
    faces = read(mesh.loop_triangle_polygons, "value", 1, np.int32)
    index = attribute(mesh, "material_index")
    chosen = np.zeros(len(faces), np.int32) if index is None else index[faces]
    return MeshArrays(
        mesh,
        points_of(mesh),
        vertices,
        triangles,
        np.clip(chosen, 0, slots - 1),
        faces,
        _normals(mesh, vertices),
    )


def _normals(mesh: bpy.types.Mesh, vertices: NDArray[np.int32]) -> NDArray[np.float32] | None:
    """Normals of corners; None: each face has one normal."""
    if mesh.normals_domain == "FACE":
        return None
    if mesh.normals_domain == "POINT":
        return read(mesh.vertex_normals, "vector", 3, np.float32)[vertices]
    return read(mesh.corner_normals, "vector", 3, np.float32)


class Meshes:
    """Meshes of a scene, each added once for all copies.

    Args:
        scene: Receives the meshes.
        materials: Materials by slot.
        notes: Receives notes on layers that are left out.
    """

    def __init__(self, scene: Scene, materials: Materials, notes: Notes) -> None:
        self._scene = scene
        self._materials = materials
        self._notes = notes
        self._made: dict[Any, Added] = {}

    def index(
        self, thing: bpy.types.Object, steps: Steps | None = None, world: Matrix = _STILL
    ) -> Parts:
        """Pairs (mesh, material) of an evaluated object of type MESH; no pairs: no faces.

        Args:
            thing: ``bpy.types.Object``, evaluated.
            steps: Points over time. Copies share the points of the first.
            world: World from the object in Blender's frame, shape (4, 4).
        """
        slots = slots_of(thing)
        plans = tuple(self._plan(material, world) for material in slots)
        key = (thing.data.as_pointer(), plans)
        if key not in self._made:
            self._made[key] = self._add(thing.data, slots, plans, steps, world)
        return [
            (mesh, self._materials.index(slots[slot]) if made is None else made)
            for mesh, slot, made in self._made[key]
        ]

    def _plan(self, material: bpy.types.Material | None, world: Matrix) -> tuple[Any, Needs | None]:
        """Key of a material made for the mesh, or the layers of a material for all meshes."""
        key = self._materials.binding(material, world)
        return (key, None) if key is not None else (None, self._materials.needs(material))

    def _add(
        self,
        mesh: bpy.types.Mesh,
        slots: Sequence[Any],
        plans: Sequence[Any],
        steps: Steps | None,
        world: Matrix,
    ) -> Added:
        """Adds a mesh for each slot that some face has."""
        source = source_of(mesh, len(slots))
        for points in (source.points, steps.points if steps else source.points):
            check_size(points, f"mesh {mesh.name_full!r}: positions")
        used = np.unique(source.slots)
        parts: Added = []
        for slot in used.tolist():
            mine = source.slots == slot
            triangles, faces = source.triangles, source.faces
            if len(used) > 1:
                triangles, faces = triangles[mine], faces[mine]
            surface = MaterialFaces(mesh, source.points, source.vertices, triangles, faces, world)
            made, needs = None, plans[slot][1]
            if needs is None:
                made, needs = self._materials.painted(slots[slot], surface)
            parts.append((self._part(source, surface, needs, steps), slot, made))
        return parts

    def _part(
        self, source: MeshArrays, surface: MaterialFaces, needs: Needs, steps: Steps | None
    ) -> int:
        """Adds some triangles, with vertices for their corners."""
        triangles = corners = surface.triangles
        index = None
        if len(triangles) < len(source.triangles):
            used = np.zeros(len(source.vertices), bool)
            used[triangles] = True
            index = np.flatnonzero(used)
            corners = (np.cumsum(used) - 1)[triangles]
        values = self._layers(source, surface, needs)
        if index is not None:
            values = {name: rows[index] for name, rows in values.items()}
        vertices = source.vertices if index is None else source.vertices[index]
        first, number = weld(vertices, *values.values())
        rows = vertices[first]
        given: dict[str, Any] = {n: freeze_in_place(value[first]) for n, value in values.items()}
        moved = None if steps is None else steps.of(rows)
        return self._scene.add_mesh(
            freeze_in_place(source.points[rows]),
            freeze_in_place(number.astype(np.uint32)[corners]),
            steps=moved,
            name=source.mesh.name_full,
            **given,
        )

    def _layers(
        self, source: MeshArrays, surface: MaterialFaces, needs: Needs
    ) -> dict[str, NDArray[np.float32]]:
        """Values of corners, by argument of ``Scene.add_mesh``."""
        found = {"normals": source.normals}
        for key, name in zip(("uv", "uv1"), needs.uv, strict=False):
            found[key] = self._uv(surface, name)
        if needs.color is not None:
            found["colors"] = self._colors(source, needs.color)
        return {key: values for key, values in found.items() if values is not None}

    def _uv(self, surface: MaterialFaces, name: str) -> NDArray[np.float32] | None:
        """Texture coordinates of corners, (0, 0) at the top left; None: there are none."""
        uv = surface.layer(name)
        if uv is None:
            if name:
                self._notes.add(f"UV map {name!r} is missing on a mesh")
            return None
        return np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)

    def _colors(self, source: MeshArrays, name: str) -> NDArray[np.float32] | None:
        """Linear colours of corners; None: there are none."""
        layers = source.mesh.color_attributes
        index = layers.find(name) if name else layers.render_color_index
        if not 0 <= index < len(layers):
            self._notes.add(f"colour attribute {name!r} is missing on a mesh")
            return None
        layer = layers[index]
        values = read(layer.data, "color", 4, np.float32)
        return values if layer.domain == "CORNER" else values[source.vertices]
