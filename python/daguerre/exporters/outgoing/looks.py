"""Materials of a scene as looks."""

from __future__ import annotations

from dataclasses import replace

from daguerre.scene.materials import (
    Boundary,
    Coated,
    Conductor,
    Dielectric,
    Diffuse,
    Gltf,
    Material,
    Mix,
    TextureSlot,
)
from daguerre.scene.scene import Scene
from daguerre.scene.spectrum import Spectrum

from .gltf_surface import gltf_look
from .pictures import BakedPicture, Baker, Color, Colored, Number, each
from .spectra import rgb_of, steps_of
from .surfaces import (
    Blend,
    Emission,
    ExportedMaterial,
    Glass,
    Lambert,
    Metal,
    Nothing,
    Plastic,
    Rough,
    Surface,
    Varnish,
)
from .texture_sets import uv_set_of


class Looks:
    """Looks of a scene's materials."""

    def __init__(self, scene: Scene, baker: Baker) -> None:
        self._materials, self._baker = scene.materials, baker
        self._notes = baker.notes

    def all(self) -> list[ExportedMaterial]:
        """Looks by the index of their material."""
        return [self._look(material) for material in self._materials]

    def _look(self, material: Material) -> ExportedMaterial:
        kind = material.kind
        look = gltf_look(kind, self._baker) if isinstance(kind, Gltf) else self._plain(material)
        if not isinstance(kind, Gltf) or material.opacity_texture or material.opacity != 1:
            own = self._baker.number(material.opacity_texture, material.opacity, 0)
            if isinstance(own, BakedPicture) and isinstance(look.opacity, BakedPicture):
                self._notes.add("second texture of opacity is written as its mean")
            look = replace(look, opacity=_product(look.opacity, own))
        if material.profile is not None:
            self._notes.add(
                "light profile of an emissive material is left out: it emits equally in "
                "all directions"
            )
        inside = material.interior or look.inside
        look = replace(look, inside=inside, outside=material.exterior, two_sided=material.two_sided)
        return self._with_emission(look, material)

    def _plain(self, material: Material) -> ExportedMaterial:
        slots = [*_slots(material), *_slots(material.kind)]
        if isinstance(material.kind, Coated):
            slots += _slots(material.kind.base)
        return ExportedMaterial(
            self.surface(material.kind),
            normals=self._baker.normals(material.normal_texture, material.normal_scale),
            uv_set=uv_set_of(slots, self._notes),
            vertex_colors=isinstance(material.kind, Diffuse),
        )

    def surface(self, kind: object) -> Surface:
        """Translates a kind of surface."""
        if isinstance(kind, Gltf):
            return gltf_look(kind, self._baker).surface
        if isinstance(kind, Diffuse):
            return Lambert(
                self._baker.color(kind.reflectance_texture, kind.reflectance),
                self._baker.color(kind.transmittance_texture, kind.transmittance),
            )
        if isinstance(kind, Conductor):
            return self._metal(kind)
        if isinstance(kind, Dielectric):
            return self._glass(kind)
        if isinstance(kind, Coated):
            return self._coated(kind)
        if isinstance(kind, Mix):
            first, second = (self._materials[i].kind for i in (kind.first, kind.second))
            amount = self._baker.number(kind.amount_texture, kind.amount, 0)
            return Blend(self.surface(first), self.surface(second), amount)
        assert isinstance(kind, Boundary)
        return Nothing()

    def _rough(self, kind: Conductor | Dielectric | Coated) -> Rough:
        u = self._baker.number(kind.alpha_texture, kind.alpha, 0)
        if kind.alpha_v is None:
            return Rough(u, distribution=kind.distribution)
        v = self._baker.number(kind.alpha_texture, kind.alpha_v, 1)
        return Rough(u, v, kind.distribution)

    def _metal(self, kind: Conductor) -> Metal:
        color = self._baker.color(kind.reflectance_texture, kind.reflectance)
        return Metal(color, self._rough(kind), eta=self._index(kind.eta), k=self._index(kind.k))

    def _index(self, value: Color | Spectrum | None) -> Spectrum | None:
        if value is None or isinstance(value, Spectrum):
            return value
        if min(value) < max(value):
            self._notes.add("index of a metal by colour is written in three steps of wavelength")
        return steps_of(value)

    def _glass(self, kind: Dielectric) -> Glass:
        if kind.dispersion > 0:
            self._notes.add("dispersion of a dielectric is left out: its index is at 587.6 nm")
        if kind.energy_compensation and kind.alpha > 0:
            self._notes.add("energy compensation of rough glass is left out: the glass is darker")
        pane = "double" if kind.thin else ""
        return Glass(kind.ior, self._rough(kind), kind.tint, kind.reflection_tint, pane)

    def _coated(self, kind: Coated) -> Surface:
        absorbs = (
            kind.absorption.values if isinstance(kind.absorption, Spectrum) else kind.absorption
        )
        if kind.thickness > 0 and max(absorbs) > 0:
            self._notes.add("absorption of a coat is left out: it is clear")
        rough, tint = self._rough(kind), kind.specular_tint
        base = self.surface(kind.base)
        if isinstance(base, Metal):
            return Varnish(base, kind.ior, rough, tint)
        assert isinstance(base, Lambert)
        kept = kind.energy_compensation
        return Plastic(base.color, kind.ior, rough, tint, kind.nonlinear, kept)

    def _with_emission(self, look: ExportedMaterial, material: Material) -> ExportedMaterial:
        """Adds the emission of a material to the emission of its kind."""
        if max(material.emission) <= 0:
            return look
        more = self._baker.color(material.emission_texture, material.emission)
        own = look.emission
        if not own.present:
            return replace(look, emission=Emission(more, material.two_sided_emission))
        if own.both_sides != material.two_sided_emission:
            self._notes.add(
                "of two emissions of a material, one on both sides, both are written on both sides"
            )
        both = material.two_sided_emission or own.both_sides
        return replace(look, emission=Emission(self._sum(own.color, more), both))

    def _sum(self, light: Colored, more: Colored) -> Colored:
        if isinstance(light, BakedPicture) and isinstance(more, BakedPicture):
            self._notes.add("second texture of emission is written as its mean")
            more = more.mean
        if isinstance(more, BakedPicture):
            light, more = more, light
        assert not isinstance(more, BakedPicture)
        rgb = rgb_of(more) if isinstance(more, Spectrum) else more
        if isinstance(light, BakedPicture):
            return light.mapped(lambda value: value + rgb)
        own = rgb_of(light) if isinstance(light, Spectrum) else light
        return own[0] + rgb[0], own[1] + rgb[1], own[2] + rgb[2]


def _slots(owner: object) -> list[TextureSlot]:
    return [slot for slot in vars(owner).values() if isinstance(slot, TextureSlot)]


def _product(a: Number, b: Number) -> Number:
    """Product of numbers; of two pictures, the first times the mean of the second."""
    if isinstance(b, BakedPicture) and not isinstance(a, BakedPicture):
        a, b = b, a
    factor = float(b.linear.mean()) if isinstance(b, BakedPicture) else b
    return a if factor == 1 else each(a, lambda value: value * factor)
