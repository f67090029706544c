"""Looks as BSDFs of Mitsuba.

Its ``plastic`` without nonlinear colour shifts has the coupling of base and coat that our
glTF materials have, (1 - E(wo)) (1 - E(wi)) / (1 - mean E); its ``principled`` has the metal.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from daguerre.exporters.outgoing.coats import head_on, sheet_ior
from daguerre.exporters.outgoing.folder import OutgoingFolder
from daguerre.exporters.outgoing.pictures import (
    BLACK,
    WHITE,
    BakedPicture,
    Colored,
    Number,
    changed,
    each,
    scaled,
)
from daguerre.exporters.outgoing.surfaces import (
    Blend,
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
from daguerre.files.notes import Notes
from daguerre.scene.spectrum import Spectrum

from .rough_plastic import Loss
from .scene_xml import Element, Values, add, add_value

#: Least difference of an index of refraction from 1 that Mitsuba takes.
_LEAST_STEP = 1e-4
#: Roughness above which a part of a coated base is diffuse, and that part over the roughness.
_EVEN_FROM, _EVEN_PART, _MOST_EVEN = 0.25, 1.5, 0.95
_D_NM = 587.56


class Bsdfs:
    """BSDFs of a file: one BSDF for each look in use."""

    def __init__(self, root: Element, folder: OutgoingFolder, notes: Notes) -> None:
        self._root, self._notes = root, notes
        self.values = Values(folder, notes)
        self._known: dict[int, str] = {}

    def id_of(self, index: int, look: ExportedMaterial) -> str:
        """Id of the BSDF of a material, which is added before its first use."""
        if index not in self._known:
            self._known[index] = f"material-{index}"
            self._add_look(look, self._known[index])
        return self._known[index]

    def _add_look(self, look: ExportedMaterial, name: str) -> None:
        parent = self._root
        if look.opacity != 1:
            parent = add(parent, "bsdf", type="mask", id=name)
            self.values.number(parent, "opacity", look.opacity)
            name = ""
        if look.two_sided and not look.clear:
            parent = add(parent, "bsdf", type="twosided", id=name)
            name = ""
        if look.normals is not None:
            parent = add(parent, "bsdf", type="normalmap", id=name)
            self.values.bitmap(parent, "normalmap", look.normals, raw=True)
            # Mitsuba 3.7.1 and later darken normal maps near the terminator; pictures here do not.
            add_value(parent, "boolean", "use_shadowing_function", False)
            name = ""
        self._add(parent, look.surface, name)

    def _add(self, parent: Element, surface: Surface, name: str = "") -> None:
        if isinstance(surface, Lambert):
            if surface.through != BLACK:
                self._notes.add("diffuse transmission is left out")
            bsdf = add(parent, "bsdf", type="diffuse", id=name)
            self.values.color(bsdf, "reflectance", surface.color)
        elif isinstance(surface, Metal):
            self._add_metal(parent, surface, name)
        elif isinstance(surface, Plastic):
            self._add_plastic(parent, surface, name)
        elif isinstance(surface, Glass):
            self._add_glass(parent, surface, name)
        elif isinstance(surface, Varnish):
            self._notes.add("coat of a metal is left out")
            self._add_metal(parent, surface.metal, name)
        elif isinstance(surface, Nothing):
            add(parent, "bsdf", type="null", id=name)
        else:
            self._add_blend(parent, surface, name)

    def _add_blend(self, parent: Element, surface: Blend, name: str) -> None:
        bsdf = add(parent, "bsdf", type="blendbsdf", id=name)
        self.values.number(bsdf, "weight", surface.amount)
        self._add(bsdf, surface.first)
        self._add(bsdf, surface.second)

    def _add_metal(self, parent: Element, surface: Metal, name: str) -> None:
        if surface.schlick:
            self._notes.add("metal of a glTF material is written as Mitsuba's principled")
            bsdf = self._principled(parent, surface.rough.u, name)
            self.values.color(bsdf, "base_color", surface.color)
            add_value(bsdf, "float", "metallic", 1.0)
            return
        smooth = surface.rough.smooth
        bsdf = add(parent, "bsdf", type="conductor" if smooth else "roughconductor", id=name)
        if surface.eta is None or surface.k is None:
            add_value(bsdf, "string", "material", "none")  # reflects all
        else:
            self.values.color(bsdf, "eta", surface.eta)
            self.values.color(bsdf, "k", surface.k)
        self._add_factor(bsdf, "specular_reflectance", surface.color)
        self._add_roughness(bsdf, surface.rough)

    def _add_plastic(self, parent: Element, surface: Plastic, name: str) -> None:
        alpha = surface.rough.u
        if _is_black(surface.color) and _is_black(surface.tint):
            self._add(parent, Lambert(BLACK), name)
        elif isinstance(alpha, BakedPicture):
            self._add_textured_plastic(parent, surface, alpha, name)
        elif surface.compensated and not surface.rough.smooth:
            self._add_rough_plastic(parent, surface, name)
        else:
            smooth = surface.rough.smooth
            bsdf = self._plastic(parent, "plastic" if smooth else "roughplastic", surface, name)
            self.values.color(bsdf, "diffuse_reflectance", surface.color)
            self._add_factor(bsdf, "specular_reflectance", surface.tint)
            self._add_round(bsdf, surface)

    def _add_textured_plastic(
        self, parent: Element, surface: Plastic, alpha: BakedPicture, name: str
    ) -> None:
        self._notes.add(
            "texture of roughness on a coat is written with Mitsuba's principled, which has a "
            "different diffuse part"
        )
        bsdf = self._principled(parent, alpha, name)
        passed = scaled(surface.color, 1 - head_on(surface.ior))
        self.values.color(bsdf, "base_color", passed)
        add_value(bsdf, "float", "eta", max(surface.ior, 1 + _LEAST_STEP))

    def _add_rough_plastic(self, parent: Element, surface: Plastic, name: str) -> None:
        """Adds a coat on a base that is brighter by the light that Mitsuba loses (``Loss``).

        Mitsuba's base depends more on the angle than ours, the rougher the more. So a part of it is
        a diffuse surface, and the coat's reflection makes up for the share of this part.
        """
        rough, share = surface.rough, 0.0
        assert not isinstance(rough.u, BakedPicture)
        loss = Loss(max(surface.ior, 1.0), rough.u, rough.distribution, surface.saturates)
        if rough.u > _EVEN_FROM and not _is_black(surface.color):
            self._notes.add(
                "rough coat on a diffuse base is a blend of Mitsuba's roughplastic and diffuse"
            )
            share = min(_EVEN_PART * rough.u, _MOST_EVEN)
            parent = add(parent, "bsdf", type="blendbsdf", id=name)
            add_value(parent, "float", "weight", share)
            name = ""
        bsdf = self._plastic(parent, "roughplastic", surface, name)
        self.values.factor(bsdf, "diffuse_reflectance", changed(surface.color, loss.shade))
        tint = changed(surface.tint, lambda light: light / (1 - share))
        self._add_factor(bsdf, "specular_reflectance", tint)
        self._add_round(bsdf, surface)
        if share > 0:
            self._add(parent, Lambert(changed(surface.color, loss.bare)))

    def _add_round(self, parent: Element, surface: Plastic) -> None:
        """Adds the roughness of a coat, which is round in Mitsuba."""
        if surface.rough.v is not None:
            self._notes.add("anisotropy of a coat is left out: its roughness is isotropic")
        self._add_roughness(parent, replace(surface.rough, v=None))

    def _plastic(self, parent: Element, kind: str, surface: Plastic, name: str) -> Element:
        bsdf = add(parent, "bsdf", type=kind, id=name)
        self._add_ior(bsdf, surface.ior)
        if surface.saturates:
            add_value(bsdf, "boolean", "nonlinear", True)
        return bsdf

    def _add_glass(self, parent: Element, surface: Glass, name: str) -> None:
        if surface.pane:
            self._add_pane(parent, surface, name)
            return
        kind = "dielectric" if surface.rough.smooth else "roughdielectric"
        bsdf = add(parent, "bsdf", type=kind, id=name)
        self._add_ior(bsdf, self._index(surface.ior))
        self._add_factor(bsdf, "specular_transmittance", surface.tint)
        self._add_factor(bsdf, "specular_reflectance", surface.reflection)
        self._add_roughness(bsdf, surface.rough)

    def _add_pane(self, parent: Element, surface: Glass, name: str) -> None:
        """Adds a sheet; a sheet of our glTF material gets another index (``sheet_ior``)."""
        ior = self._index(surface.ior)
        if not surface.rough.smooth:
            self._notes.add("roughness of a thin sheet of glass is left out")
        if surface.pane == "single":
            self._notes.add("thin sheet of glass reflects as here at normal incidence only")
            ior = sheet_ior(ior)
        bsdf = add(parent, "bsdf", type="thindielectric", id=name)
        self._add_ior(bsdf, ior)
        self._add_factor(bsdf, "specular_transmittance", surface.tint)
        self._add_factor(bsdf, "specular_reflectance", surface.reflection)

    def _index(self, ior: float | Spectrum) -> float:
        if not isinstance(ior, Spectrum):
            return ior
        self._notes.add("dispersion of glass is left out: its index is at 587.6 nm")
        return float(ior.at(_D_NM))

    def _principled(self, parent: Element, alpha: Number, name: str) -> Element:
        bsdf = add(parent, "bsdf", type="principled", id=name)
        self.values.number(bsdf, "roughness", each(alpha, np.sqrt))
        return bsdf

    def _add_factor(self, bsdf: Element, name: str, color: Colored) -> None:
        if color != WHITE:
            self.values.factor(bsdf, name, color)

    def _add_roughness(self, bsdf: Element, rough: Rough) -> None:
        if rough.smooth:
            return
        add_value(bsdf, "string", "distribution", rough.distribution)
        if rough.v is None:
            self.values.number(bsdf, "alpha", rough.u)
        else:
            self.values.number(bsdf, "alpha_u", rough.u)
            self.values.number(bsdf, "alpha_v", rough.v)

    def _add_ior(self, bsdf: Element, ior: float) -> None:
        add_value(bsdf, "float", "int_ior", ior if abs(ior - 1) > _LEAST_STEP else 1 + _LEAST_STEP)
        add_value(bsdf, "float", "ext_ior", 1.0)


def _is_black(color: Colored) -> bool:
    """Whether nothing is reflected; Mitsuba then divides 0 by 0 for its choice of lobes."""
    if isinstance(color, BakedPicture):
        return bool(color.pixels.max() <= 0)
    return max(color.values if isinstance(color, Spectrum) else color) <= 0
