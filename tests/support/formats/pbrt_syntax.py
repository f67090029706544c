"""Checks a text against the documented syntax of pbrt-v4 (pbrt.org/fileformat-v4).

It knows the directives, the types of parameters and the names that each kind takes, as far as
a writer here uses them, and nothing of the writer.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

_TOKEN = re.compile(r'\s*(?:#[^\n]*\n?|("(?:[^"\\]|\\.)*")|([\[\]])|([^\s"\[\]#]+))')
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\Z")
#: Numbers that a value of a type has; None: any.
_COUNTS = {
    "float": 1, "integer": 1, "rgb": 3, "point3": 3, "vector3": 3, "spectrum": None, "bool": 1,
    "string": 1, "texture": 1,
}  # fmt: skip
_ROUGH = {"roughness", "uroughness", "vroughness", "remaproughness", "normalmap", "displacement"}
#: Names of parameters by directive and kind.
KINDS: dict[tuple[str, str], set[str]] = {
    ("Camera", "perspective"): {"fov", "screenwindow", "lensradius", "focaldistance"},
    ("Camera", "realistic"): {"lensfile", "aperturediameter", "focusdistance", "aperture"},
    ("Film", "rgb"): {"xresolution", "yresolution", "diagonal", "sensor", "iso", "filename"},
    ("PixelFilter", "box"): {"xradius", "yradius"},
    ("Sampler", "halton"): {"pixelsamples", "seed"},
    ("Integrator", "volpath"): {"maxdepth", "regularize"},
    ("LightSource", "point"): {"I", "scale", "power", "from"},
    ("LightSource", "goniometric"): {"I", "scale", "power", "filename"},
    ("LightSource", "distant"): {"L", "scale", "from", "to", "illuminance"},
    ("LightSource", "infinite"): {"L", "scale", "filename", "illuminance", "portal"},
    ("AreaLightSource", "diffuse"): {"L", "scale", "twosided", "filename", "power"},
    ("Shape", "plymesh"): {"filename", "alpha"},
    ("Shape", "sphere"): {"radius", "zmin", "zmax", "phimax", "alpha"},
    ("Shape", "curve"): {"P", "basis", "degree", "type", "width0", "width1", "alpha"},
    ("Material", "diffuse"): {"reflectance"},
    ("MakeNamedMaterial", "diffuse"): {"reflectance", "normalmap"},
    ("MakeNamedMaterial", "diffusetransmission"): {"reflectance", "transmittance", "normalmap"},
    ("MakeNamedMaterial", "conductor"): {"reflectance", "eta", "k", *_ROUGH},
    ("MakeNamedMaterial", "dielectric"): {"eta", *_ROUGH},
    ("MakeNamedMaterial", "thindielectric"): {"eta", "normalmap"},
    ("MakeNamedMaterial", "coateddiffuse"): {
        "reflectance", "eta", "thickness", "g", "albedo", "maxdepth", "nsamples", *_ROUGH,
    },
    ("MakeNamedMaterial", "coatedconductor"): {
        "interface.eta", "interface.roughness", "interface.uroughness", "interface.vroughness",
        "conductor.eta", "conductor.k", "reflectance", "conductor.roughness",
        "conductor.uroughness", "conductor.vroughness", "thickness", "maxdepth", "nsamples",
        "remaproughness", "normalmap",
    },
    ("MakeNamedMaterial", "mix"): {"materials", "amount"},
    ("MakeNamedMaterial", "interface"): set(),
    ("MakeNamedMedium", "homogeneous"): {"sigma_a", "sigma_s", "Le", "g", "scale"},
    ("MakeNamedMedium", "uniformgrid"): {
        "sigma_a", "sigma_s", "g", "density", "nx", "ny", "nz", "p0", "p1",
    },
    ("Texture", "imagemap"): {
        "filename", "encoding", "wrap", "filter", "uscale", "vscale", "udelta", "vdelta", "scale",
    },
}  # fmt: skip
_BEFORE_WORLD = {"Camera", "Film", "PixelFilter", "Sampler", "Integrator", "Transform"}
_ANYWHERE = {"Transform", "MakeNamedMedium", "MediumInterface"}


@dataclass
class Directive:
    """A directive: its name, words in quotes before parameters, numbers, and parameters."""

    name: str
    words: list[str] = field(default_factory=list)
    numbers: list[float] = field(default_factory=list)
    parameters: dict[str, tuple[str, list[str]]] = field(default_factory=dict)

    def values(self, name: str) -> list[float]:
        """Numbers of a parameter."""
        return [float(value) for value in self.parameters[name][1]]

    def text(self, name: str) -> str:
        """The text of a parameter."""
        (value,) = self.parameters[name][1]
        return value.strip('"')


def read(text: str) -> list[Directive]:
    """Reads and checks a file; asserts that it is right."""
    found = [_checked(one) for one in _directives(_tokens(text))]
    names = [one.name for one in found]
    assert names.count("WorldBegin") == 1
    world = names.index("WorldBegin")
    for one in found[:world]:
        assert one.name in _BEFORE_WORLD | _ANYWHERE, one
    for one in found[world + 1 :]:
        assert one.name not in _BEFORE_WORLD - _ANYWHERE, one
    _check_blocks(found)
    _check_names(found)
    return found


def _tokens(text: str) -> list[str]:
    found, at = [], 0
    while at < len(text.rstrip()):
        match = _TOKEN.match(text, at)
        assert match is not None, text[at : at + 40]
        found += [token for token in match.groups() if token]
        at = match.end()
    return found


def _directives(tokens: list[str]) -> list[Directive]:
    found: list[Directive] = []
    i = 0
    while i < len(tokens):
        token = tokens[i]
        if token[0].isalpha():
            found.append(Directive(token))
            i += 1
            continue
        here = found[-1]
        if token == "[" or (token[0] == '"' and i + 1 < len(tokens) and tokens[i + 1] == "["):
            named = token != "["
            start = i + 1 + named
            end = tokens.index("]", start)
            values = tokens[start:end]
            if named:
                kind, name = token.strip('"').split()
                assert name not in here.parameters, (here, name)
                here.parameters[name] = kind, values
            else:
                here.numbers = [float(value) for value in values]
            i = end + 1
            continue
        assert token[0] == '"', token
        here.words.append(token.strip('"'))
        i += 1
    return found


def _checked(one: Directive) -> Directive:
    if one.name == "Transform":
        assert len(one.numbers) == 16
        return one
    kinds = {
        "Texture": lambda: one.words[2], "MakeNamedMaterial": lambda: one.text("type"),
        "MakeNamedMedium": lambda: one.text("type"),
    }  # fmt: skip
    simple = {
        "WorldBegin", "AttributeBegin", "AttributeEnd", "ObjectBegin", "ObjectEnd",
        "ObjectInstance", "NamedMaterial", "MediumInterface",
    }  # fmt: skip
    if one.name in simple:
        assert not one.parameters, one
        assert not one.numbers, one
        return one
    kind = kinds.get(one.name, lambda: one.words[0])()
    assert (one.name, kind) in KINDS, one
    if one.name == "Texture":
        assert one.words[1] in ("float", "spectrum")
    allowed = KINDS[one.name, kind] | ({"type"} if one.name.startswith("Make") else set())
    for name, (of, values) in one.parameters.items():
        assert name in allowed, (one, name)
        _check_values(one, name, of, values)
    return one


def _check_values(one: Directive, name: str, of: str, values: list[str]) -> None:
    assert of in _COUNTS, (one, of)
    if of in ("string", "texture"):
        assert all(value[0] == value[-1] == '"' for value in values), (one, name)
    elif of == "bool":
        assert values in (["true"], ["false"])
    elif of != "spectrum":
        assert all(_NUMBER.match(value) for value in values), (one, name, values)
    if of == "spectrum":
        assert len(values) % 2 == 0
        assert values
    elif name not in ("screenwindow", "materials", "density", "P"):
        assert len(values) == _COUNTS[of], (one, name)
    if of == "integer":
        assert all("." not in value and "e" not in value for value in values)


def _check_blocks(found: list[Directive]) -> None:
    stack: list[str] = []
    for one in found:
        if one.name.endswith("Begin") and one.name != "WorldBegin":
            stack.append(one.name[: -len("Begin")])
            assert stack.count("Object") <= 1
        elif one.name.endswith("End"):
            assert stack.pop() == one.name[: -len("End")]
        if "Object" in stack:
            assert one.name != "AreaLightSource", "pbrt has no instances of lights"
    assert not stack


def _check_names(found: list[Directive]) -> None:
    """Each name is made before its use, and once."""
    made: dict[str, set[str]] = {
        "material": set(),
        "medium": set(),
        "texture": set(),
        "object": set(),
    }
    for one in found:
        for kind, maker in (
            ("material", "MakeNamedMaterial"), ("medium", "MakeNamedMedium"),
            ("texture", "Texture"), ("object", "ObjectBegin"),
        ):  # fmt: skip
            if one.name == maker:
                assert one.words[0] not in made[kind], one
                made[kind].add(one.words[0])
        uses = {"NamedMaterial": "material", "ObjectInstance": "object"}
        if one.name in uses:
            assert one.words[0] in made[uses[one.name]], one
        if one.name == "MediumInterface":
            assert all(not word or word in made["medium"] for word in one.words), one
        for name, (of, values) in one.parameters.items():
            if of == "texture":
                assert values[0].strip('"') in made["texture"], one
            if name == "materials":
                assert all(value.strip('"') in made["material"] for value in values), one
