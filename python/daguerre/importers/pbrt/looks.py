"""Materials of the scene: the look of a surface with its light, its masks and its media."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace

from daguerre.scene.materials import LITERAL, Boundary, Diffuse, Kind, Material, TextureSlot
from daguerre.scene.media import Medium
from daguerre.scene.scene import Scene

from .description import named
from .emission import DARK, Emission
from .ledger import Ledger
from .materials import OF_V4, Appearance, Reader, Tools
from .media import Media
from .old_materials import OF_V3
from .state import Entity
from .textures import Shade, Textures

#: Largest depth of mixtures within mixtures.
_DEEPEST = 16
#: Default material of surfaces, as in pbrt.
_USUAL = Appearance(Diffuse((0.5, 0.5, 0.5)))


class Looks:
    """Makes the materials of shapes, each once.

    Args:
        scene: Receives materials.
        tools: Tools of material readers, without ``part``.
        media: Media of the scene.
        ledger: Counts directives.
    """

    def __init__(self, scene: Scene, tools: Tools, media: Media, ledger: Ledger) -> None:
        self._scene, self._media, self._ledger = scene, media, ledger
        self._tools = replace(tools, part=self._part)
        self._looks: dict[Entity, Appearance] = {}
        self._open: list[Entity] = []
        self._indices: dict[tuple[object, ...], int] = {}
        readers: dict[str, Reader] = (
            {**OF_V4, **OF_V3} if tools.version == 3 else {**OF_V3, **OF_V4}
        )
        self._readers = readers

    @property
    def textures(self) -> Textures:
        """Textures of the scene."""
        return self._tools.textures

    def of(self, shape: Entity) -> Appearance:
        """Look of a shape's material.

        Raises:
            InputError: The material is undefined or wrong.
        """
        material = shape.state.material
        if material is None:
            return _USUAL
        if isinstance(material, str):
            material = named(shape.materials, material, shape.place, "material")
        return self._look(material)

    def mask(self, shape: Entity) -> Shade:
        """Covered share of a shape."""
        shape.parameters.find("shadowalpha")
        return self.textures.number(shape, "alpha", 1.0)

    def index(
        self, shape: Entity, look: Appearance, mask: Shade, emission: Emission, slope: float = 1.0
    ) -> int:
        """Index of the material of a shape.

        Args:
            shape: The shape.
            look: Look of its material.
            mask: Mask of the shape.
            emission: Light of the shape.
            slope: Factor on the slopes of its bumps.
        """
        slope = float(f"{slope:.3g}") if look.bump is not None and look.normals is None else 1.0
        inside = self._media.inside(shape.state.inside, shape)
        outside = self._media.named(shape.state.outside)
        kind = look.kind
        if isinstance(kind, Boundary) and emission is not DARK:
            kind = Diffuse((0.0, 0.0, 0.0))
        slot = self._glow(emission)
        shine = (emission.color, emission.two_sided, slot)
        key = (id(look), mask, *shine, id(inside), id(outside), slope)
        if key not in self._indices:
            material = self._material(kind, look, mask, inside, outside)
            material = replace(material, normal_scale=slope)
            if emission is not DARK:
                material = replace(
                    material,
                    emission=emission.color,
                    two_sided_emission=emission.two_sided,
                    emission_texture=slot,
                )
            self._indices[key] = self._scene.add_material(material)
        return self._indices[key]

    def _material(
        self,
        kind: Kind,
        look: Appearance,
        mask: Shade,
        inside: Medium | None,
        outside: Medium | None,
    ) -> Material:
        opacity = min(max(mask.number, 0.0), 1.0) * look.opacity
        if mask.slot is not None and look.opacity_slot is not None:
            self._ledger.notes.add("of two masks of a surface the one of its material is left out")
        return Material(
            kind,
            opacity=opacity,
            opacity_texture=mask.slot or look.opacity_slot,
            normal_texture=look.normals or look.bump,
            interior=inside,
            exterior=outside,
            nesting=LITERAL,
        )

    def _glow(self, emission: Emission) -> TextureSlot | None:
        if not emission.picture or emission.directive is None:
            return None
        place = str(emission.directive.place)
        index = self.textures.picture(place, emission.picture)
        return None if index is None else TextureSlot(index)

    def _look(self, entity: Entity) -> Appearance:
        if entity not in self._looks:
            if entity in self._open:
                entity.place.fail("mixes form a cycle: the material contains itself")
            if len(self._open) >= _DEEPEST:
                entity.place.fail(f"too many nested mixtures: the limit is {_DEEPEST}")
            self._open.append(entity)
            self._looks[entity] = self._read(entity)
            self._open.pop()
        return self._looks[entity]

    def _read(self, entity: Entity) -> Appearance:
        is_named = entity.place.directive == "MakeNamedMaterial"
        kind = entity.parameters.text("type") if is_named else entity.kind
        if is_named and not kind:
            entity.place.fail("type: missing, wanted a kind of material")
        reader = self._readers.get(kind)
        if reader is None:
            known = ", ".join(name for name in OF_V4 if name)
            entity.place.fail(f"kind: wanted {known}, got {kind[:40]!r}")
        textures = self.textures
        textures.space = None
        found = reader(replace(entity, kind=kind), self._tools)
        look = found if isinstance(found, Appearance) else Appearance(found)
        look = replace(
            look, normals=self._normals(entity), bump=self._bump(entity), space=textures.space
        )
        self._ledger.use(entity.place)
        self._ledger.tell_unread(entity.parameters, entity.place, kind)
        return look

    def _normals(self, entity: Entity) -> TextureSlot | None:
        name = entity.parameters.text("normalmap")
        index = self.textures.picture(str(entity.place), name, srgb=False) if name else None
        return None if index is None else TextureSlot(index)

    def _bump(self, entity: Entity) -> TextureSlot | None:
        name = "bumpmap" if entity.parameters.has("bumpmap") else "displacement"
        return self.textures.bump(entity, name)

    def _part(self, owner: Entity, name: str) -> tuple[int, Kind]:
        """Adds a part of a mixture."""
        entity = named(owner.materials, name, owner.place, "material")
        look = self._look(entity)
        if look.opacity != 1 or look.opacity_slot is not None:
            self._ledger.notes.add("a partly transparent part of a mixture is opaque")
        key = ("part", id(look))
        if key not in self._indices:
            material = Material(look.kind, normal_texture=look.normals)
            self._indices[key] = self._scene.add_material(material)
        return self._indices[key], look.kind


def has_slots(value: object) -> bool:
    """Whether a surface or a material has a slot of a texture, also in its parts."""
    if isinstance(value, TextureSlot):
        return True
    if not is_dataclass(value) or isinstance(value, type):
        return False
    return any(has_slots(getattr(value, field.name)) for field in fields(value))
