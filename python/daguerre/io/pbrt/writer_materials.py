"""Looks as materials of pbrt, with their textures."""

from __future__ import annotations

from daguerre.files.notes import Notes
from daguerre.io.outgoing.coats import base_below, sheet_ior
from daguerre.io.outgoing.folder import OutgoingFolder
from daguerre.io.outgoing.picture_file import write_pixels
from daguerre.io.outgoing.pictures import Colored, Number, Picture
from daguerre.io.outgoing.surfaces import (
    WHITE,
    Blend,
    Glass,
    Lambert,
    Look,
    Metal,
    Plastic,
    Surface,
    is_smooth,
)

from .writer_text import Parameter, Text, flag, floats, integer, rgb, string, texture

#: Bounces between coat and base; pbrt's own limit of 10 loses light of bright bases.
_COAT_BOUNCES = 100
_COAT_SAMPLES = 4


class Materials:
    """Materials and textures of a file, each once."""

    def __init__(self, text: Text, folder: OutgoingFolder, notes: Notes) -> None:
        self.text, self.folder, self.notes = text, folder, notes
        self._known: dict[int, str] = {}
        self._textures: dict[str, str] = {}

    def name_of(self, index: int, look: Look) -> str:
        """Name of the material of a look, which is added before its first use."""
        if index not in self._known:
            self._known[index] = f"material-{index}"
            self._add(self._known[index], look.surface, self._normals(look))
        return self._known[index]

    def number(self, name: str, value: Number) -> Parameter:
        """Makes a parameter of a number or of a texture of numbers."""
        if isinstance(value, Picture):
            return texture(name, self._texture("float", value))
        return floats(name, float(value))

    def color(self, name: str, value: Colored) -> Parameter:
        """Makes a parameter of a colour or of a texture of colours."""
        if isinstance(value, Picture):
            return texture(name, self._texture("spectrum", value))
        return rgb(name, value)

    def _normals(self, look: Look) -> list[Parameter]:
        if look.normals is None:
            return []
        if look.normals.transform != (1, 0, 0, 0, 1, 0):
            self.notes.add("transform of a normal map is left out: pbrt has none")
        if look.normals.wrap != ("repeat", "repeat"):
            self.notes.add("normal map repeats beyond its edges")
        return [string("normalmap", write_pixels(self.folder, "normals", look.normals.pixels))]

    def _add(self, name: str, surface: Surface, normals: list[Parameter]) -> None:
        if isinstance(surface, Blend):
            self._add_blend(name, surface, normals)
            return
        kind, parameters = self._parameters(surface)
        self.text.directive("MakeNamedMaterial", name, string("type", kind), *parameters, *normals)

    def _add_blend(self, name: str, surface: Blend, normals: list[Parameter]) -> None:
        for part, of in (("first", surface.first), ("second", surface.second)):
            self._add(f"{name}-{part}", of, normals)
        self.text.directive(
            "MakeNamedMaterial", name, string("type", "mix"),
            string("materials", f"{name}-first", f"{name}-second"),
            self.number("amount", surface.amount),
        )  # fmt: skip

    def _parameters(self, surface: Surface) -> tuple[str, list[Parameter]]:
        if isinstance(surface, Lambert):
            return "diffuse", [self.color("reflectance", surface.color)]
        if isinstance(surface, Metal):
            return self._metal(surface)
        if isinstance(surface, Plastic):
            return self._plastic(surface)
        assert isinstance(surface, Glass)
        return self._glass(surface)

    def _metal(self, surface: Metal) -> tuple[str, list[Parameter]]:
        self.notes.add(
            "metal of one colour at all angles is brighter at grazing angles in pbrt"
            if not surface.schlick
            else "metal of a glTF material has the Fresnel term of a conductor of that colour"
        )
        return "conductor", [self.color("reflectance", surface.color), *self._rough(surface.alpha)]

    def _plastic(self, surface: Plastic) -> tuple[str, list[Parameter]]:
        if surface.tint != WHITE:
            self.notes.add("factor on what a glTF dielectric reflects is left out")
        self.notes.add(
            "diffuse base of a glTF dielectric is written darker, as pbrt's coat saturates it"
        )
        return "coateddiffuse", [
            self.color("reflectance", base_below(surface.color, surface.ior)),
            floats("eta", surface.ior),
            integer("maxdepth", _COAT_BOUNCES),
            integer("nsamples", _COAT_SAMPLES),
            *self._rough(surface.alpha),
        ]

    def _glass(self, surface: Glass) -> tuple[str, list[Parameter]]:
        if surface.tint != WHITE:
            self.notes.add("colour of glass is left out: pbrt's is clear")
        if not surface.thin:
            return "dielectric", [floats("eta", surface.ior), *self._rough(surface.alpha)]
        if not is_smooth(surface.alpha):
            self.notes.add("roughness of a thin sheet of glass is left out")
        self.notes.add("thin sheet of glass reflects as ours at normal incidence alone")
        return "thindielectric", [floats("eta", sheet_ior(surface.ior))]

    def _rough(self, alpha: Number) -> list[Parameter]:
        given = 0.0 if is_smooth(alpha) else alpha
        return [self.number("roughness", given), flag("remaproughness", False)]

    def _texture(self, kind: str, picture: Picture) -> str:
        made = picture.without_mirrors()
        a, b, c, d, e, f = made.transform
        if b or d:
            self.notes.add(
                "rotation of texture coordinates is left out: pbrt scales and moves them"
            )
        wrap = made.wrap[0]
        if made.wrap[1] != wrap:
            self.notes.add(f"texture with two ways to go on beyond its edges has {wrap} for both")
        parameters = [
            string("filename", write_pixels(self.folder, "texture", made.pixels)),
            string("encoding", "sRGB" if made.srgb else "linear"),
            string("wrap", wrap),
            string("filter", "point" if made.nearest else "bilinear"),
            # v points down in ours, and up in pbrt: v' = e v + f with v = 1 - t.
            floats("uscale", a), floats("vscale", e), floats("udelta", c),
            floats("vdelta", 1 - e - f),
        ]  # fmt: skip
        key = f"{kind} {' '.join(parameters)}"
        if key not in self._textures:
            self._textures[key] = f"texture-{len(self._textures)}"
            self.text.line(
                f'Texture "{self._textures[key]}" "{kind}" "imagemap" {" ".join(parameters)}'
            )
        return self._textures[key]
