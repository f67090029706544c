"""Materials of a scene as looks."""

from __future__ import annotations

from dataclasses import replace

from daguerre.scene.materials import Conductor, Dielectric, Diffuse, Gltf, Material

from .gltf_surface import gltf_look
from .pictures import Baker, Colored, Picture
from .surfaces import BLACK, Emission, Glass, Lambert, Look, Metal


def look_of(material: Material, baker: Baker) -> Look:
    """Translates a material with its emission."""
    look = _look(material, baker)
    if material.profile is not None:
        baker.notes.add("light profile of an emissive material is left out: it shines evenly")
    if max(material.emission) <= 0:
        return look
    own = look.emission
    if own.present and own.both_sides != material.two_sided_emission:
        baker.notes.add("two emissions of a material, one to both sides, are written to both")
    both = material.two_sided_emission or (own.present and own.both_sides)
    return replace(look, emission=Emission(_sum(own.color, material.emission), both))


def _look(material: Material, baker: Baker) -> Look:
    kind = material.kind
    if isinstance(kind, Gltf):
        return gltf_look(kind, baker)
    if isinstance(kind, Conductor):
        return Look(Metal(kind.reflectance, kind.alpha))
    if isinstance(kind, Dielectric):
        if kind.dispersion > 0:
            baker.notes.add("dispersion of a dielectric is left out: its index is that at 587.6 nm")
        return Look(Glass(kind.ior, kind.alpha, kind.tint))
    assert isinstance(kind, Diffuse)
    return Look(Lambert(kind.reflectance))


def _sum(own: Colored, more: tuple[float, float, float]) -> Colored:
    if isinstance(own, Picture):
        return own.mapped(lambda light: light + more)
    return own[0] + more[0], own[1] + more[1], own[2] + more[2]


def dark(look: Look) -> bool:
    """Whether nothing is reflected, as of a lamp."""
    return isinstance(look.surface, Lambert) and look.surface.color == BLACK
