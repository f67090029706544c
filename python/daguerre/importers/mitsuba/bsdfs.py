"""Materials of Mitsuba: plugins that need no other BSDF.

Mitsuba's opaque surfaces are black from behind unless ``twosided`` is around them. Its microfacets
are Beckmann's by default.

Source: Mitsuba 3, documentation of BSDFs.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from daguerre.errors import UsageError
from daguerre.files.notes import Notes
from daguerre.scene.materials import (
    Boundary,
    Coated,
    Color,
    Conductor,
    Dielectric,
    Diffuse,
    Spectrum,
)

from .ior import relative_index
from .look import Appearance
from .node import Node
from .principled import principled, principled_thin
from .textures import Textures

_DISTRIBUTIONS = ("beckmann", "ggx", "phong", "as")


class Surfaces:
    """Reads surfaces.

    Args:
        textures: Reads their colours and textures.
        notes: Receives notes.
    """

    def __init__(self, textures: Textures, notes: Notes) -> None:
        self.textures, self.notes = textures, notes

    def look(self, node: Node) -> Appearance | None:
        """Look of a material; None: the plugin is not read here."""
        read = _PLUGINS.get(node.plugin)
        return None if read is None else read(self, node)

    def _diffuse(self, node: Node) -> Appearance:
        painted = self.textures.painted(node, "reflectance")
        if painted is not None:
            return Appearance(Diffuse(painted.factors), attribute=painted.attribute)
        reflectance, texture = self.textures.tint(node, "reflectance", 0.5)
        return Appearance(Diffuse(reflectance, texture))

    def _transmitter(self, node: Node) -> Appearance:
        """Diffuse transmission (``difftrans`` of Mitsuba 0.6)."""
        transmittance, texture = self.textures.tint(node, "transmittance", 0.5)
        kind = Diffuse((0.0, 0.0, 0.0), transmittance=transmittance, transmittance_texture=texture)
        return Appearance(kind, two_sided=True)

    def _conductor(self, node: Node) -> Appearance:
        return Appearance(self._metal(node, 0.0, {}))

    def _rough_conductor(self, node: Node) -> Appearance:
        fields = self._roughness(node)
        return Appearance(self._metal(node, fields.pop("alpha"), fields))

    def _metal(self, node: Node, alpha: float, fields: dict[str, Any]) -> Conductor:
        reflectance, texture = self.textures.tint(node, "specular_reflectance", 1.0)
        made: dict[str, Any] = {"reflectance": reflectance, "reflectance_texture": texture}
        made |= {"alpha": alpha} | fields
        material = node.text("material", "none").strip()
        measured = node.has("eta") or node.has("k")
        if measured or material.lower() == "none":
            return self._by_index(node, made) if measured else Conductor(**made)
        try:
            return Conductor.of_metal(material, **made)
        except UsageError:
            self.notes.add(f"the metal {material[:40]!r} is unknown: it is read as a mirror")
            return Conductor(**made)

    def _by_index(self, node: Node, made: dict[str, Any]) -> Conductor:
        """Metal by eta and k over the index outside."""
        outside = node.number("ext_eta", 1.0, above=0) if node.has("ext_eta") else 1.0
        eta, k = (
            _over(self.textures.color(node, name, default), outside)
            for name, default in (("eta", 0.0), ("k", 1.0))
        )
        return Conductor(**made, eta=eta, k=k)

    def _dielectric(self, node: Node) -> Appearance:
        return Appearance(self._glass(node, {}), two_sided=True)

    def _rough_dielectric(self, node: Node) -> Appearance:
        return Appearance(self._glass(node, self._roughness(node)), two_sided=True)

    def _thin_dielectric(self, node: Node) -> Appearance:
        return Appearance(self._glass(node, {"thin": True}), two_sided=True)

    def _glass(self, node: Node, fields: dict[str, Any]) -> Dielectric:
        share = self.textures.share
        return Dielectric(
            ior=relative_index(node, "bk7"),
            tint=share(node, "specular_transmittance", 1.0),
            reflection_tint=share(node, "specular_reflectance", 1.0),
            **fields,
        )

    def _plastic(self, node: Node) -> Appearance:
        return self._coated(node, {})

    def _rough_plastic(self, node: Node) -> Appearance:
        return self._coated(node, self._roughness(node) | {"energy_compensation": False})

    def _coated(self, node: Node, fields: dict[str, Any]) -> Appearance:
        reflectance, texture = self.textures.tint(node, "diffuse_reflectance", 0.5)
        kind = Coated(
            Diffuse(reflectance, texture),
            ior=relative_index(node, "polypropylene"),
            specular_tint=self.textures.share(node, "specular_reflectance", 1.0),
            nonlinear=node.flag("nonlinear", False),
            **fields,
        )
        return Appearance(kind)

    def _null(self, node: Node) -> Appearance:
        return Appearance(Boundary(), two_sided=True)

    def _principled(self, node: Node) -> Appearance:
        return principled(node, self.textures, self.notes)

    def _principled_thin(self, node: Node) -> Appearance:
        return principled_thin(node, self.textures, self.notes)

    def _roughness(self, node: Node) -> dict[str, Any]:
        """Roughness along u and v, and the distribution of normals."""
        name = node.choice("distribution", "beckmann", _DISTRIBUTIONS)
        if name not in ("beckmann", "ggx"):
            self.notes.add("microfacets of Phong's distribution are drawn as Beckmann's")
        node.skip("sample_visible")
        return {"distribution": "ggx" if name == "ggx" else "beckmann"} | self._alphas(node)

    def _alphas(self, node: Node) -> dict[str, Any]:
        if not (node.has("alpha_u") or node.has("alpha_v")):
            alpha, slot = self.textures.scalar(node, "alpha", 0.1)
            return {"alpha": alpha} | ({"alpha_texture": slot} if slot is not None else {})
        along = self.textures.channel(node, "alpha_u", 0.1)
        across = self.textures.channel(node, "alpha_v", 0.1)
        packed = self.textures.packer.packed((along, across), places=(0, 1))
        slot = packed.slot
        fields: dict[str, Any] = {"alpha": packed.factors[0], "alpha_v": packed.factors[1]}
        return fields | ({"alpha_texture": slot} if slot is not None else {})


def _over(value: Color | Spectrum, outside: float) -> Color | Spectrum:
    if outside == 1.0:
        return value
    if isinstance(value, Spectrum):
        return Spectrum(value.wavelengths_nm, tuple(v / outside for v in value.values))
    r, g, b = (c / outside for c in value)
    return r, g, b


_PLUGINS: dict[str, Callable[[Surfaces, Node], Appearance]] = {
    "diffuse": Surfaces._diffuse,
    "difftrans": Surfaces._transmitter,
    "conductor": Surfaces._conductor,
    "roughconductor": Surfaces._rough_conductor,
    "dielectric": Surfaces._dielectric,
    "roughdielectric": Surfaces._rough_dielectric,
    "thindielectric": Surfaces._thin_dielectric,
    "plastic": Surfaces._plastic,
    "roughplastic": Surfaces._rough_plastic,
    "principled": Surfaces._principled,
    "principledthin": Surfaces._principled_thin,
    "null": Surfaces._null,
}
