"""Reads materials of pbrt-v4.

Source: pbrt-v4's user's guide ("Materials"); Pharr, Jakob and Humphreys 2023, chapters 9 and 14.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from daguerre.scene.materials import (
    Boundary,
    Coated,
    Conductor,
    Dielectric,
    Diffuse,
    Kind,
    Mix,
    TextureSlot,
)
from daguerre.scene.spectrum import Spectrum

from .indices import Indices
from .ledger import Ledger
from .roughness import Roughness, roughness_of
from .spectra import Color, Spectra
from .state import Entity
from .subsurface import diffuse_reflectance, scattering_of
from .texture_mapping import SpaceMapping
from .textures import Textures

_WHITE: Color = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Appearance:
    """Look of a surface.

    Attributes:
        kind: Kind of material.
        normals: Slot of a normal map.
        bump: Slot of a normal map with slopes that each mesh scales.
        opacity: Covered share of the surface.
        opacity_slot: Slot of factors on the opacity.
        space: Mapping of set 1 of texture coordinates.
    """

    kind: Kind
    normals: TextureSlot | None = None
    bump: TextureSlot | None = None
    opacity: float = 1.0
    opacity_slot: TextureSlot | None = None
    space: SpaceMapping | None = None


@dataclass(frozen=True)
class Tools:
    """Tools that readers of materials need.

    Attributes:
        textures: Textures of the scene.
        indices: Indices of refraction.
        spectra: Spectra.
        version: Version of pbrt, 3 or 4.
        ledger: Counts directives.
        part: Adds a material by name, for mixtures; returns its index and kind.
    """

    textures: Textures
    indices: Indices
    spectra: Spectra
    version: int
    ledger: Ledger
    part: Callable[[Entity, str], tuple[int, Kind]]

    def note(self, sentence: str) -> None:
        """Adds a note."""
        self.ledger.notes.add(sentence)

    def roughness(self, entity: Entity, default: float = 0.0, prefix: str = "") -> Roughness:
        """Reads roughness; see ``roughness_of``."""
        return roughness_of(entity, self.textures, self.version, self.ledger, default, prefix)


Reader = Callable[[Entity, Tools], Kind | Appearance]


def diffuse(entity: Entity, tools: Tools) -> Kind:
    """Reads ``diffuse``."""
    shade = tools.textures.color(entity, "reflectance", (0.5, 0.5, 0.5))
    return Diffuse(shade.color, shade.slot)


def conductor(entity: Entity, tools: Tools) -> Kind:
    """Reads ``conductor``: by its index, or by its reflectance."""
    return metal(entity, tools, "", 0.0)


def metal(entity: Entity, tools: Tools, prefix: str, roughness: float) -> Conductor:
    """Reads a metal with parameters that begin with ``prefix``."""
    rough = tools.roughness(entity, roughness, prefix)
    if tools.textures.has(entity, "reflectance"):
        shade = tools.textures.color(entity, "reflectance", _WHITE)
        return Conductor(
            shade.color, rough.alpha, shade.slot, rough.alpha_v, alpha_texture=rough.slot
        )
    eta, k = tools.indices.metal(entity, f"{prefix}eta", f"{prefix}k")
    return Conductor(
        alpha=rough.alpha, alpha_v=rough.alpha_v, alpha_texture=rough.slot, eta=eta, k=k
    )


def dielectric(entity: Entity, tools: Tools) -> Kind:
    """Reads ``dielectric``."""
    rough = tools.roughness(entity)
    ior = tools.indices.glass(entity, ("eta",), 1.5)
    return Dielectric(ior, rough.alpha, alpha_v=rough.alpha_v, alpha_texture=rough.slot)


def thin_dielectric(entity: Entity, tools: Tools) -> Kind:
    """Reads ``thindielectric``."""
    return Dielectric(tools.indices.glass(entity, ("eta",), 1.5), thin=True)


def coated_diffuse(entity: Entity, tools: Tools) -> Kind:
    """Reads ``coateddiffuse``."""
    rough = tools.roughness(entity)
    base = diffuse(entity, tools)
    assert isinstance(base, Diffuse)
    return _coated(base, rough, tools.indices.glass(entity, ("eta",), 1.5), entity, tools)


def coated_conductor(entity: Entity, tools: Tools) -> Kind:
    """Reads ``coatedconductor``."""
    rough = tools.roughness(entity, 0.0, "interface.")
    ior = tools.indices.glass(entity, ("interface.eta",), 1.5)
    return _coated(metal(entity, tools, "conductor.", 0.0), rough, ior, entity, tools)


def _coated(
    base: Diffuse | Conductor,
    rough: Roughness,
    ior: float | Spectrum,
    entity: Entity,
    tools: Tools,
) -> Coated:
    layers = ("thickness", "g", "albedo", "maxdepth", "nsamples", "twosided")
    for name in layers:
        entity.parameters.find(name)
    albedo = tools.textures.color(entity, "albedo", (0.0, 0.0, 0.0))
    if albedo.slot is not None or max(albedo.color) > 0:
        tools.note("a medium between coat and base is left out")
    index = float(ior.at(587.6)) if isinstance(ior, Spectrum) else ior
    alpha_v, slot = rough.alpha_v, rough.slot
    return Coated(base, max(index, 1.0), rough.alpha, alpha_v=alpha_v, alpha_texture=slot)


def diffuse_transmission(entity: Entity, tools: Tools) -> Kind:
    """Reads ``diffusetransmission``."""
    quarter = (0.25, 0.25, 0.25)
    scale = entity.parameters.number("scale", 1.0, 0.0)
    entity.parameters.find("remaproughness")
    back = tools.textures.color(entity, "reflectance", quarter)
    through = tools.textures.color(entity, "transmittance", quarter)
    return Diffuse(_times(back.color, scale), back.slot, _times(through.color, scale), through.slot)


def subsurface(entity: Entity, tools: Tools) -> Kind:
    """Reads ``subsurface`` as a coated surface of the color that light has when it leaves."""
    tools.note("a material of kind 'subsurface' is drawn as a coated surface of its color")
    rough = tools.roughness(entity)
    ior = tools.indices.glass(entity, ("eta", "index"), 1.33)
    for name in ("mfp", "g", "scale", "Kr", "Kt"):
        entity.parameters.find(name)
    name = "Kd" if tools.textures.has(entity, "Kd") else "reflectance"
    if tools.textures.has(entity, name):
        shade = tools.textures.color(entity, name, (0.5, 0.5, 0.5))
        return _coated(Diffuse(shade.color, shade.slot), rough, ior, entity, tools)
    absorbed, scattered = scattering_of(entity, tools.spectra, tools.ledger.notes)
    index = float(ior.at(587.6)) if isinstance(ior, Spectrum) else ior
    color = diffuse_reflectance(absorbed, scattered, index)
    return _coated(Diffuse(color), rough, ior, entity, tools)


def measured(entity: Entity, tools: Tools) -> Kind:
    """Reads ``measured``, which is not supported."""
    tools.note(f"a material of kind {entity.kind[:40]!r} is drawn as a grey diffuse surface")
    for parameter in entity.parameters.unread():
        entity.parameters.find(parameter.name)
    return Diffuse()


def hair(entity: Entity, tools: Tools) -> Kind:
    """Reads ``hair`` as a diffuse surface of its color."""
    tools.note("a material of kind 'hair' is drawn as a diffuse surface of its color")
    for name in ("sigma_a", "eumelanin", "pheomelanin", "eta", "beta_m", "beta_n", "alpha"):
        entity.parameters.find(name)
    name = "reflectance" if tools.textures.has(entity, "reflectance") else "color"
    shade = tools.textures.color(entity, name, (0.15, 0.08, 0.04))
    return Diffuse(shade.color, shade.slot)


def interface(entity: Entity, tools: Tools) -> Kind:
    """Reads ``interface``, which only bounds media."""
    del entity, tools
    return Boundary()


def mix(entity: Entity, tools: Tools) -> Kind | Appearance:
    """Reads ``mix`` of two named materials."""
    names = entity.parameters.texts("materials")
    if len(names) != 2:
        entity.place.fail(f"materials: wanted two names, got {len(names)}")
    return mixed(entity, tools, names[0], names[1])


def mixed(entity: Entity, tools: Tools, first: str, second: str) -> Kind | Appearance:
    """Mixture of two named materials; ``amount`` is the share of the second.

    An invisible part makes the other part partly transparent.
    """
    (a, kind), (b, other) = (tools.part(entity, name) for name in (first, second))
    if isinstance(other, Boundary):
        shade = tools.textures.number(
            entity, "amount", 0.5, lambda values: 1 - values, "1 - amount"
        )
        return Appearance(kind, opacity=_share(shade.number), opacity_slot=shade.slot)
    shade = tools.textures.number(entity, "amount", 0.5)
    if isinstance(kind, Boundary):
        return Appearance(other, opacity=_share(shade.number), opacity_slot=shade.slot)
    return Mix(a, b, _share(shade.number), shade.slot)


def _share(value: float) -> float:
    return float(np.clip(value, 0.0, 1.0))


def _times(color: Color, factor: float) -> Color:
    red, green, blue = (min(value * factor, 1.0) for value in color)
    return red, green, blue


OF_V4: dict[str, Reader] = {
    "": interface,
    "none": interface,
    "interface": interface,
    "diffuse": diffuse,
    "coateddiffuse": coated_diffuse,
    "coatedconductor": coated_conductor,
    "diffusetransmission": diffuse_transmission,
    "dielectric": dielectric,
    "thindielectric": thin_dielectric,
    "conductor": conductor,
    "measured": measured,
    "subsurface": subsurface,
    "hair": hair,
    "mix": mix,
}
