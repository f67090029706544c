"""Adds the shapes of a scene: meshes with their materials at their places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.scene.far import single_if_near
from daguerre.scene.scene import Scene
from daguerre.scene.subdivision import Subdivision

from .bump import strength
from .curves import Strands, group_of
from .emission import DARK, Emission, Emissions
from .files import Files
from .ledger import Ledger
from .looks import Looks, has_slots
from .materials import Appearance
from .placing import Placing, Spots
from .shapes import LocalMesh, surface_of
from .state import Entity
from .textures import Shade
from .transforms import Moving, scaling

#: Maximum number of triangles of spheres, patches and subdivided surfaces of a scene.
MAX_TRIANGLES = 1 << 25


class Meshes:
    """Adds shapes to a scene.

    Args:
        scene: The scene.
        files: Files of the scene.
        looks: Materials.
        emissions: Light of surfaces.
        placing: Places of meshes.
        ledger: Counts directives.
    """

    def __init__(
        self,
        scene: Scene,
        files: Files,
        looks: Looks,
        emissions: Emissions,
        placing: Placing,
        ledger: Ledger,
    ) -> None:
        self._scene, self._files, self._looks = scene, files, looks
        self._emissions, self._placing, self._ledger = emissions, placing, ledger
        self._meshes: dict[tuple[object, ...], int] = {}
        self._left = MAX_TRIANGLES

    def add(self, shapes: list[Entity], outer: list[Moving] | None, name: str = "") -> None:
        """Adds shapes.

        Args:
            shapes: Shapes of an object, or shapes outside of objects.
            outer: Transforms of the object's instances; None: there is no object.
            name: Node of the object.

        Raises:
            InputError: A parameter or a file is wrong.
        """
        strands: dict[tuple[object, ...], Strands] = {}
        for entity in shapes:
            if entity.kind == "curve":
                group = strands.setdefault(group_of(entity), Strands(entity))
                group.add(entity, self._ledger.notes)
            else:
                self._shape(entity, outer, name)
        for group in strands.values():
            self._strands(group, outer, name)

    def _spots(self, entity: Entity, outer: list[Moving] | None, name: str, own: str) -> Spots:
        if outer is None:
            return Spots(self._placing.name(own), [Moving()], entity.place)
        return Spots(name, outer, entity.place)

    def _shape(self, entity: Entity, outer: list[Moving] | None, name: str) -> None:
        surface = surface_of(entity, self._files, self._ledger.notes)
        if isinstance(surface, str):
            self._ledger.note(entity.place, surface, entity.parameters.text("filename"))
            return
        look, mask = self._looks.of(entity), self._looks.mask(entity)
        spots = self._spots(entity, outer, name, surface.name or entity.kind)
        for emission, chosen in self._lit(entity, surface, outer):
            part = surface
            if chosen is not None:
                part = replace(surface, triangles=surface.triangles[chosen], key=None)
            world = entity.state.transform.start
            slope = 1.0 if look.bump is None else strength(surface, world)
            material = self._looks.index(entity, look, mask, emission, slope)
            mesh = self._mesh(part, entity, look, mask, emission)
            inner = entity.state.transform
            if part.size != 1:
                inner = inner.times_matrix(scaling(np.full(3, part.size)), True, True)
            self._placing.add(mesh, material, inner, spots)
        self._ledger.use(entity.place)
        self._ledger.tell_unread(entity.parameters, entity.place, entity.kind)

    def _lit(
        self, entity: Entity, surface: LocalMesh, outer: list[Moving] | None
    ) -> list[tuple[Emission, NDArray[np.bool_] | None]]:
        light = entity.state.emission
        if light is not None and outer is not None:
            sentence = "an AreaLightSource of an object is left out, as in pbrt"
            self._ledger.note(light.place, sentence)
            light = None
        return self._emissions.of(light, surface, entity.state.transform.start)

    def _mesh(
        self, surface: LocalMesh, entity: Entity, look: Appearance, mask: Shade, emission: Emission
    ) -> int:
        textured = has_slots(look) or has_slots(mask) or bool(emission.picture)
        if textured:
            surface = surface.with_uv()
        uv1 = None
        if look.space is not None and not surface.level:
            world = entity.state.transform.start
            local = surface.positions.astype(np.float64) * surface.size
            points = local @ world[:3, :3].T + world[:3, 3]
            uv1 = _down(look.space.coordinates(points))
            surface = replace(surface, key=None)
        if surface.key is None:
            self._spend(surface, entity)
            return self._add(surface, uv1)
        if surface.key not in self._meshes:
            self._spend(surface, entity)
            self._meshes[surface.key] = self._add(surface, None)
        return self._meshes[surface.key]

    def _spend(self, surface: LocalMesh, entity: Entity) -> None:
        """Counts triangles that no file holds, and stops at too many."""
        if entity.kind in ("trianglemesh", "plymesh"):
            return
        self._left -= len(surface.triangles) << 2 * surface.level
        if self._left < 0:
            entity.place.fail(f"too many triangles of shapes: the limit is {MAX_TRIANGLES}")

    def _add(self, surface: LocalMesh, uv1: NDArray[np.float32] | None) -> int:
        positions = freeze_in_place(np.ascontiguousarray(single_if_near(surface.positions)))
        triangles = freeze_in_place(np.ascontiguousarray(surface.triangles, np.uint32))
        if surface.level:
            return self._scene.add_mesh(
                positions,
                triangles,
                subdivision=Subdivision("loop", level=surface.level),
                name=surface.name,
            )
        normals = surface.normals
        return self._scene.add_mesh(
            positions,
            triangles,
            None if normals is None else _unit(normals),
            None if surface.uv is None else _down(surface.uv),
            uv1=uv1,
            name=surface.name,
        )

    def _strands(self, strands: Strands, outer: list[Moving] | None, name: str) -> None:
        entity = strands.first
        mesh = self._scene.add_curves(
            np.concatenate(strands.points),
            [len(points) for points in strands.points],
            np.concatenate(strands.widths),
            basis="bezier",
            name="curves",
        )
        look, mask = self._looks.of(entity), self._looks.mask(entity)
        if entity.state.emission is not None:
            self._ledger.note(entity.state.emission.place, "the light of curves is left out")
        material = self._looks.index(entity, look, mask, DARK)
        self._placing.add(mesh, material, Moving(), self._spots(entity, outer, name, "curves"))
        for strand in strands.all:
            if strand.state.transform.moves:
                self._ledger.notes.add("a moving curve stays at its first place")
            self._ledger.use(strand.place)
            self._ledger.tell_unread(strand.parameters, strand.place, strand.kind)


def _down(uv: NDArray[np.floating]) -> NDArray[np.float32]:
    """Texture coordinates with (0, 0) at the top left."""
    flipped = np.array(uv, np.float32)
    flipped[:, 1] = 1 - flipped[:, 1]
    return flipped


def _unit(normals: NDArray[np.floating]) -> NDArray[np.float32]:
    found = np.array(normals, np.float32)
    lengths = np.linalg.norm(found, axis=1, keepdims=True)
    return np.asarray(found / np.where(lengths > 0, lengths, 1), np.float32)
