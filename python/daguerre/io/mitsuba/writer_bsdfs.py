"""Looks as BSDFs of Mitsuba.

Its ``plastic`` without nonlinear colour shifts has the coupling of base and coat that our
glTF materials have, (1 - E(wo)) (1 - E(wi)) / (1 - mean E); its ``principled`` has the metal.
"""

from __future__ import annotations

import numpy as np

from daguerre.files.notes import Notes
from daguerre.io.outgoing.coats import sheet_ior
from daguerre.io.outgoing.folder import OutgoingFolder
from daguerre.io.outgoing.pictures import Colored, Picture, each, scaled
from daguerre.io.outgoing.surfaces import (
    BLACK,
    WHITE,
    Blend,
    Glass,
    Lambert,
    Look,
    Metal,
    Plastic,
    Surface,
    clear,
    is_smooth,
)

from .writer_xml import Element, Values, add, add_rgb, add_value

#: Least difference of an index of refraction from 1 that Mitsuba takes.
_LEAST_STEP = 1e-4
#: Share of a rough coat beside its base, in which it is that much brighter.
_COAT_SHARE = 0.02


class Bsdfs:
    """BSDFs of a file, one for each look that is used."""

    def __init__(self, root: Element, folder: OutgoingFolder, notes: Notes) -> None:
        self._root, self._notes = root, notes
        self.values = Values(folder, notes)
        self._known: dict[int, str] = {}

    def id_of(self, index: int, look: Look) -> str:
        """Id of the BSDF of a material, which is added before its first use."""
        if index not in self._known:
            self._known[index] = f"material-{index}"
            self._add_look(look, self._known[index])
        return self._known[index]

    def _add_look(self, look: Look, name: str) -> None:
        parent = self._root
        if look.opacity != 1:
            parent = add(parent, "bsdf", type="mask", id=name)
            self.values.number(parent, "opacity", look.opacity)
            name = ""
        if not clear(look.surface):
            parent = add(parent, "bsdf", type="twosided", id=name)
            name = ""
        if look.normals is not None:
            parent = add(parent, "bsdf", type="normalmap", id=name)
            self.values.bitmap(parent, "normalmap", look.normals, raw=True)
            name = ""
        self._add(parent, look.surface, name)

    def _add(self, parent: Element, surface: Surface, name: str = "") -> None:
        if isinstance(surface, Lambert):
            bsdf = add(parent, "bsdf", type="diffuse", id=name)
            self.values.color(bsdf, "reflectance", surface.color)
        elif isinstance(surface, Metal):
            self._add_metal(parent, surface, name)
        elif isinstance(surface, Plastic):
            self._add_plastic(parent, surface, name)
        elif isinstance(surface, Glass):
            self._add_glass(parent, surface, name)
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
            bsdf = self._principled(parent, surface.alpha, name)
            self.values.color(bsdf, "base_color", surface.color)
            add_value(bsdf, "float", "metallic", 1.0)
            return
        smooth = is_smooth(surface.alpha)
        kind = "conductor" if smooth else "roughconductor"
        bsdf = add(parent, "bsdf", type=kind, id=name)
        add_value(bsdf, "string", "material", "none")  # reflects all
        self.values.color(bsdf, "specular_reflectance", surface.color)
        if not smooth:
            self._add_roughness(bsdf, surface.alpha)

    def _add_plastic(self, parent: Element, surface: Plastic, name: str) -> None:
        alpha = surface.alpha
        if isinstance(alpha, Picture):
            self._notes.add(
                "texture of roughness below a glTF dielectric is written with Mitsuba's "
                "principled, whose diffuse part is another"
            )
            bsdf = self._principled(parent, alpha, name)
            passed = 1 - ((surface.ior - 1) / (surface.ior + 1)) ** 2  # by the coat, head on
            self.values.color(bsdf, "base_color", scaled(surface.color, passed))
            add_value(bsdf, "float", "eta", max(surface.ior, 1 + _LEAST_STEP))
            return
        if not is_smooth(alpha):
            self._add_rough_plastic(parent, surface, alpha, name)
            return
        bsdf = self._plastic(parent, "plastic", surface.ior, name)
        self.values.color(bsdf, "diffuse_reflectance", surface.color)
        if surface.tint != WHITE:
            self.values.color(bsdf, "specular_reflectance", surface.tint)

    def _add_rough_plastic(
        self, parent: Element, surface: Plastic, alpha: float, name: str
    ) -> None:
        """Adds the base below a smooth coat, and beside it the rough coat on nothing.

        Mitsuba's ``roughplastic`` loses the light that facets send down: half of it at roughness
        0.7. It blends, and does not add, so both parts are as much brighter as their shares are
        small.
        """
        self._notes.add(
            "rough glTF dielectric is a blend of the base of a smooth plastic and a rough coat"
        )
        if _is_black(surface.color):
            self._add_coat(parent, surface, alpha, 1.0, name)
            return
        bsdf = add(parent, "bsdf", type="blendbsdf", id=name)
        add_value(bsdf, "float", "weight", _COAT_SHARE)
        base = self._plastic(bsdf, "plastic", surface.ior, "")
        self.values.color(base, "diffuse_reflectance", scaled(surface.color, 1 / (1 - _COAT_SHARE)))
        add_value(base, "spectrum", "specular_reflectance", 0.0)
        self._add_coat(bsdf, surface, alpha, _COAT_SHARE, "")

    def _add_coat(
        self, parent: Element, surface: Plastic, alpha: float, share: float, name: str
    ) -> None:
        """Adds a rough coat on nothing, which counts as if its share were 1."""
        coat = self._plastic(parent, "roughplastic", surface.ior, name)
        add_rgb(coat, "diffuse_reflectance", BLACK)
        add_value(coat, "spectrum", "specular_reflectance", _grey(surface.tint) / share)
        self._add_roughness(coat, alpha)

    def _plastic(self, parent: Element, kind: str, ior: float, name: str) -> Element:
        bsdf = add(parent, "bsdf", type=kind, id=name)
        self._add_ior(bsdf, ior)
        return bsdf

    def _add_glass(self, parent: Element, surface: Glass, name: str) -> None:
        if surface.thin:
            self._add_sheet(parent, surface, name)
            return
        smooth = is_smooth(surface.alpha)
        bsdf = add(parent, "bsdf", type="dielectric" if smooth else "roughdielectric", id=name)
        self._add_ior(bsdf, surface.ior)
        if surface.tint != WHITE:
            self.values.color(bsdf, "specular_transmittance", surface.tint)
        if not smooth:
            self._add_roughness(bsdf, surface.alpha)

    def _add_sheet(self, parent: Element, surface: Glass, name: str) -> None:
        """Adds a sheet whose own internal reflections bring it to ours at normal incidence."""
        if not is_smooth(surface.alpha):
            self._notes.add("roughness of a thin sheet of glass is left out")
        self._notes.add("thin sheet of glass reflects as ours at normal incidence alone")
        bsdf = add(parent, "bsdf", type="thindielectric", id=name)
        self._add_ior(bsdf, sheet_ior(surface.ior))
        if surface.tint != WHITE:
            self.values.color(bsdf, "specular_transmittance", surface.tint)

    def _principled(self, parent: Element, alpha: float | Picture, name: str) -> Element:
        bsdf = add(parent, "bsdf", type="principled", id=name)
        self.values.number(bsdf, "roughness", each(alpha, np.sqrt))
        return bsdf

    def _add_roughness(self, bsdf: Element, alpha: float | Picture) -> None:
        add_value(bsdf, "string", "distribution", "ggx")
        self.values.number(bsdf, "alpha", alpha)

    def _add_ior(self, bsdf: Element, ior: float) -> None:
        add_value(bsdf, "float", "int_ior", ior if abs(ior - 1) > _LEAST_STEP else 1 + _LEAST_STEP)
        add_value(bsdf, "float", "ext_ior", 1.0)


def _grey(tint: Colored) -> float:
    mean = tint.linear.mean() if isinstance(tint, Picture) else sum(tint) / 3
    return float(mean)


def _is_black(color: Colored) -> bool:
    """Whether nothing is reflected; Mitsuba then divides 0 by 0 for its choice of lobes."""
    return bool(color.pixels.max() <= 0) if isinstance(color, Picture) else max(color) <= 0
