"""Placed meshes as shapes of pbrt: alone, or as instances of an object."""

from __future__ import annotations

from daguerre.exporters.outgoing.meshes import MeshFiles
from daguerre.exporters.outgoing.picture_file import write_pixels
from daguerre.exporters.outgoing.pictures import IDENTITY, BakedPicture
from daguerre.exporters.outgoing.placing import Placed
from daguerre.exporters.outgoing.surfaces import Emission, ExportedMaterial

from .materials import Materials
from .media import Media
from .text import Parameter, Text, flag, string


class Shapes:
    """Shapes of a file."""

    def __init__(
        self,
        text: Text,
        looks: list[ExportedMaterial],
        materials: Materials,
        meshes: MeshFiles,
        media: Media,
    ) -> None:
        self._text, self._looks, self._media = text, looks, media
        self._materials, self._meshes = materials, meshes
        self._objects = 0

    def add(self, placed: Placed) -> None:
        """Adds a mesh at all of its places; pbrt has no instances of lights."""
        look = self._looks[placed.material]
        material = self._materials.name_of(placed.material, look)
        shape = self._shape(placed, look)
        self._media.names_of(placed.material, look)  # defined before their use
        if len(placed.transforms) > 1 and not look.emission.present:
            self._add_object(placed, material, shape)
            return
        for transform in placed.transforms:
            with self._text.block("Attribute"):
                self._text.transform(transform)
                self._add_shape(placed, material, shape)

    def _add_object(self, placed: Placed, material: str, shape: list[Parameter]) -> None:
        name = f"object-{self._objects}"
        self._objects += 1
        with self._text.block("Object", name):
            self._add_shape(placed, material, shape)
        for transform in placed.transforms:
            with self._text.block("Attribute"):
                self._text.transform(transform)
                self._text.line(f'ObjectInstance "{name}"')

    def _add_shape(self, placed: Placed, material: str, shape: list[Parameter]) -> None:
        look = self._looks[placed.material]
        self._text.line(f'NamedMaterial "{material}"')
        if sides := self._media.names_of(placed.material, look):
            self._text.line('MediumInterface "{}" "{}"'.format(*sides))
        if look.emission.present:
            self._text.directive("AreaLightSource", "diffuse", *self._emission(look.emission))
        self._text.directive("Shape", "plymesh", *shape)

    def _shape(self, placed: Placed, look: ExportedMaterial) -> list[Parameter]:
        parameters = [string("filename", self._meshes.path(placed.mesh, look))]
        if look.opacity != 1:
            parameters.append(self._materials.number("alpha", look.opacity))
        return parameters

    def _emission(self, emission: Emission) -> list[Parameter]:
        light = emission.color
        sides = flag("twosided", emission.both_sides)
        if not isinstance(light, BakedPicture):
            return [self._materials.color("L", light), sides]
        notes = self._materials.notes
        if light.transform != IDENTITY or light.wrap != ("repeat", "repeat"):
            notes.add("picture of emitted light covers texture coordinates 0 to 1 once")
        path = write_pixels(self._materials.folder, "light", light.pixels)
        return [string("filename", path), sides]
