"""Directives of a scene: their names and their arguments."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import suggest
from daguerre.files.json_item import short

from .lexer import Lexer, text_of
from .parameters import Parameters, read_parameters
from .place import FilePlace

#: Directives by their arguments: strings, then numbers, then whether parameters follow.
_ARGUMENTS: dict[str, tuple[int, int, bool]] = {
    **dict.fromkeys(
        ("Accelerator", "AreaLightSource", "Attribute", "Camera", "Film", "Integrator"),
        (1, 0, True),
    ),
    **dict.fromkeys(
        ("LightSource", "MakeNamedMaterial", "MakeNamedMedium", "Material", "PixelFilter"),
        (1, 0, True),
    ),
    **dict.fromkeys(("Renderer", "Sampler", "Shape", "SurfaceIntegrator"), (1, 0, True)),
    "VolumeIntegrator": (1, 0, True),
    "Texture": (3, 0, True),
    **dict.fromkeys(
        ("ColorSpace", "CoordSysTransform", "CoordinateSystem", "Import"), (1, 0, False)
    ),
    **dict.fromkeys(("NamedMaterial", "ObjectBegin", "ObjectInstance"), (1, 0, False)),
    "MediumInterface": (1, 0, False),
    "Option": (1, 0, False),
    **dict.fromkeys(
        ("AttributeBegin", "AttributeEnd", "Identity", "ObjectEnd", "ReverseOrientation"),
        (0, 0, False),
    ),
    **dict.fromkeys(("TransformBegin", "TransformEnd", "WorldBegin", "WorldEnd"), (0, 0, False)),
    "ActiveTransform": (0, 0, False),
    "ConcatTransform": (0, 16, False),
    "LookAt": (0, 9, False),
    "Rotate": (0, 4, False),
    "Scale": (0, 3, False),
    "Transform": (0, 16, False),
    "TransformTimes": (0, 2, False),
    "Translate": (0, 3, False),
}
NAMES = (*_ARGUMENTS, "Include")
#: Directives that only pbrt-v3 has.
OF_V3 = ("WorldEnd", "SurfaceIntegrator", "VolumeIntegrator", "Renderer", "TransformBegin")
_WHAT = {"Texture": ("a name", "a type", "a class")}


@dataclass(frozen=True, eq=False)
class Directive:
    """A directive with its arguments.

    Attributes:
        name: Name of the directive.
        place: Place of the directive.
        strings: Strings after the name; for ``ActiveTransform`` its word.
        numbers: Numbers after them.
        parameters: Parameters after them.
    """

    name: str
    place: FilePlace
    strings: tuple[str, ...] = ()
    numbers: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))
    parameters: Parameters = field(default_factory=Parameters)


def directives_of(lexer: Lexer) -> Iterator[Directive]:
    """Yields the directives of a text; the lexer itself follows ``Include``.

    Raises:
        InputError: The text is wrong; the message has file, line, column and directive.
    """
    while (token := lexer.token()) is not None:
        yield _directive(lexer, token)


def _directive(lexer: Lexer, token: bytes) -> Directive:
    name = token.decode("utf-8", "replace")
    if name not in _ARGUMENTS:
        what = short(name, 40)
        lexer.place().fail(f"wanted a directive, got {what}{suggest(name[:40], NAMES)}")
    place = lexer.place(name)
    strings, numbers, has_parameters = _ARGUMENTS[name]
    wanted = _WHAT.get(name, ("a name",) * strings)
    given = tuple(lexer.string(place, what) for what in wanted)
    given += _more_strings(lexer, place, name)
    return Directive(
        name,
        place,
        given,
        _numbers(lexer, place, numbers),
        read_parameters(lexer, place) if has_parameters else Parameters(),
    )


def _more_strings(lexer: Lexer, place: FilePlace, name: str) -> tuple[str, ...]:
    """Reads arguments that only some directives have."""
    if name == "MediumInterface" and lexer.peek() == b'"':
        return (lexer.string(place, "a name"),)
    if name in ("ActiveTransform", "Option"):
        token = lexer.token()
        if token is None:
            place.fail("the file ends where a word must follow")
        return (text_of(token) if token[:1] == b'"' else token.decode("utf-8", "replace"),)
    return ()


def _numbers(lexer: Lexer, place: FilePlace, count: int) -> NDArray[np.float64]:
    bracketed = count > 0 and lexer.peek() == b"["
    if bracketed:
        lexer.token()
    found = np.array([lexer.number(place) for _ in range(count)], np.float64)
    if bracketed and lexer.token() != b"]":
        place.at(lexer.offset).fail(f"wanted ] after {count} numbers")
    return found
