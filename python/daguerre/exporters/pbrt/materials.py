"""Looks as materials of pbrt, with their textures."""

from __future__ import annotations

from daguerre.exporters.outgoing.coats import base_below, sheet_ior
from daguerre.exporters.outgoing.folder import OutgoingFolder
from daguerre.exporters.outgoing.picture_file import write_pixels
from daguerre.exporters.outgoing.pictures import (
    BLACK,
    IDENTITY,
    WHITE,
    BakedPicture,
    Colored,
    Number,
)
from daguerre.exporters.outgoing.spectra import samples
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

from .text import Parameter, Text, flag, floats, integer, rgb, spectrum, string, texture

#: Bounces between coat and base; pbrt's own limit of 10 loses light of bright bases.
_COAT = (integer("maxdepth", 100), integer("nsamples", 4))


class Materials:
    """Materials and textures of a file, each once."""

    def __init__(self, text: Text, folder: OutgoingFolder, notes: Notes) -> None:
        self.text, self.folder, self.notes = text, folder, notes
        self._known: dict[int, str] = {}
        self._textures: dict[str, str] = {}

    def name_of(self, index: int, look: ExportedMaterial) -> str:
        """Name of the material of a look, which is added before its first use."""
        if index not in self._known:
            if not look.two_sided:
                self.notes.add("single-sided surface is visible from behind, too")
            self._known[index] = f"material-{index}"
            self._add(self._known[index], look.surface, self._normals(look))
        return self._known[index]

    def number(self, name: str, value: Number) -> Parameter:
        """Makes a parameter of a number or of a texture of numbers."""
        if isinstance(value, BakedPicture):
            return texture(name, self._texture("float", value))
        return floats(name, float(value))

    def color(self, name: str, value: Colored) -> Parameter:
        """Makes a parameter of a colour or of a texture of colours."""
        if isinstance(value, BakedPicture):
            return texture(name, self._texture("spectrum", value))
        if isinstance(value, Spectrum):
            return spectrum(name, samples(value))
        return rgb(name, value)

    def _normals(self, look: ExportedMaterial) -> list[Parameter]:
        if look.normals is None:
            return []
        if look.normals.transform != IDENTITY:
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
            return self._diffuse(surface)
        if isinstance(surface, Metal):
            return "conductor", [*self._metal(surface, ""), *self._rough(surface.rough)]
        if isinstance(surface, Plastic):
            return self._plastic(surface)
        if isinstance(surface, Varnish):
            return self._varnish(surface)
        if isinstance(surface, Nothing):
            return "interface", []
        assert isinstance(surface, Glass)
        return self._glass(surface)

    def _diffuse(self, surface: Lambert) -> tuple[str, list[Parameter]]:
        reflected = self.color("reflectance", surface.color)
        if surface.through == BLACK:
            return "diffuse", [reflected]
        return "diffusetransmission", [reflected, self.color("transmittance", surface.through)]

    def _metal(self, surface: Metal, prefix: str) -> list[Parameter]:
        """Parameters of a metal; ``prefix`` of their names below a coat."""
        if surface.eta is not None and surface.k is not None:
            if surface.color != WHITE:
                self.notes.add("factor on the reflectance of a metal is left out")
            return [
                self.color(f"{prefix}eta", surface.eta),
                self.color(f"{prefix}k", surface.k),
            ]
        self.notes.add(
            "metal of a glTF material has the Fresnel term of a conductor of that colour"
            if surface.schlick
            else "metal of one colour is brighter at grazing angles in pbrt"
        )
        return [self.color("reflectance", surface.color)]

    def _plastic(self, surface: Plastic) -> tuple[str, list[Parameter]]:
        self._note_tint(surface.tint)
        color = surface.color
        if not surface.saturates:
            self.notes.add(
                "diffuse base below a coat is written darker, because interreflections saturate "
                "it in pbrt"
            )
            color = base_below(color, surface.ior)
        return "coateddiffuse", [
            self.color("reflectance", color),
            floats("eta", surface.ior),
            *_COAT,
            *self._rough(surface.rough),
        ]

    def _varnish(self, surface: Varnish) -> tuple[str, list[Parameter]]:
        self._note_tint(surface.tint)
        return "coatedconductor", [
            *self._metal(surface.metal, "conductor."),
            floats("interface.eta", surface.ior),
            *_COAT,
            *self._rough(surface.rough, "interface."),
            *self._rough(surface.metal.rough, "conductor.")[:-1],
        ]

    def _glass(self, surface: Glass) -> tuple[str, list[Parameter]]:
        if surface.tint != WHITE or surface.reflection != WHITE:
            self.notes.add("colour of glass is left out: pbrt's is clear")
        if not surface.pane:
            return "dielectric", [self._index(surface.ior), *self._rough(surface.rough)]
        if not surface.rough.smooth:
            self.notes.add("roughness of a thin sheet of glass is left out")
        if surface.pane == "double" or isinstance(surface.ior, Spectrum):
            return "thindielectric", [self._index(surface.ior)]
        self.notes.add("thin sheet of glass reflects as here at normal incidence only")
        return "thindielectric", [floats("eta", sheet_ior(surface.ior))]

    def _index(self, ior: float | Spectrum) -> Parameter:
        return self.color("eta", ior) if isinstance(ior, Spectrum) else floats("eta", ior)

    def _note_tint(self, tint: Colored) -> None:
        if tint != WHITE:
            self.notes.add("factor on what a coat reflects is left out")

    def _rough(self, rough: Rough, prefix: str = "") -> list[Parameter]:
        plain = flag("remaproughness", False)
        if rough.smooth:
            return [floats(f"{prefix}roughness", 0.0), plain]
        if rough.distribution != "ggx":
            self.notes.add(
                "Beckmann's distribution of facets is written as GGX of the same roughness"
            )
        if rough.v is None:
            return [self.number(f"{prefix}roughness", rough.u), plain]
        u, v = (self.number(f"{prefix}{n}roughness", value)
                for n, value in (("u", rough.u), ("v", rough.v)))  # fmt: skip
        return [u, v, plain]

    def _texture(self, kind: str, picture: BakedPicture) -> str:
        made = picture.without_mirrors()
        a, b, c, d, e, f = made.transform
        if b or d:
            self.notes.add(
                "rotation of texture coordinates is left out: pbrt scales and moves them"
            )
        wrap = made.wrap[0]
        if made.wrap[1] != wrap:
            self.notes.add(f"texture with two wrap modes has {wrap} for both")
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
