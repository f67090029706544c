"""Colours that OpenEXR and Radiance files state: all light is converted to linear Rec.709 here.

Readers of environments, plates, frames, textures and the darkroom's pictures convert here. Data do
not pass: pictures of irises, point spreads, masks, STMaps, depth, motion and normals keep their
numbers, whatever the header says.

The first attribute that a header has, counts: ``acesImageContainerFlag`` (SMPTE ST 2065-4),
``colorInteropID``, ``chromaticities``, and last the names that programs write (``oiio:ColorSpace``,
``colorspace``). This is the order of the Color Interop Forum's "Identifying the Color Space of
OpenEXR Files". Light of a file that says nothing keeps its bits.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import short
from daguerre.color.encodings import (
    LINEAR,
    XYZ_D65,
    Encoding,
    curved,
    encoding_in_file,
    encoding_of_primaries,
    encoding_of_space,
    is_data,
    linear,
    rec709_from,
    through,
    title_of,
)
from daguerre.files.notes import Notes

Light = NDArray[np.float32]
FLAG, ID, CORNERS = "acesImageContainerFlag", "colorInteropID", "chromaticities"
_NAMES = ("oiio:colorspace", "colorspace")
#: Rows that are converted at once, and that are few enough for a processor's cache.
_STRIPE = 64


@dataclass(frozen=True)
class Colors:
    """Colour encoding of a file.

    Attributes:
        encoding: Curve, primaries and white of its numbers.
        stated_by: Attribute that states it; empty: none.
        remarks: Sentences on statements of the header that are not followed.
    """

    encoding: Encoding = LINEAR
    stated_by: str = ""
    remarks: tuple[str, ...] = ()

    @property
    def is_plain(self) -> bool:
        """Whether the numbers are linear Rec.709 already, and keep their bits."""
        return self.encoding.is_linear and self.encoding.is_rec709

    @property
    def sentence(self) -> str:
        """Note on the conversion; empty: no conversion."""
        if self.is_plain:
            return ""
        adapted = "" if _keeps_white(self.encoding) else "; its white is adapted (Bradford)"
        found = f"{title_of(self.encoding)} ({self.stated_by})"
        return f"colors are converted to linear Rec.709 from {found}{adapted}"

    @property
    def sentences(self) -> list[str]:
        """All notes."""
        return [*filter(None, [self.sentence]), *self.remarks]

    def tell(self, notes: Notes, name: str = "") -> None:
        """Adds the notes; ``name``: the file."""
        for sentence in self.sentences:
            notes.add(sentence, name=name)

    def light(self, values: Light, *, in_place: bool = False) -> Light:
        """Converts numbers of the file, shape (H, W, 3), to linear Rec.709, which may be negative.

        Args:
            values: The numbers.
            in_place: Whether the values may be overwritten, which saves memory.

        Returns:
            The same array if nothing is converted, or in place; else a new array.
        """
        if self.is_plain:
            return values
        made = values if in_place else np.empty(values.shape, np.float32)
        matrix = np.array(rec709_from(self.encoding))
        for row in range(0, len(values), _STRIPE):
            part = linear(values[row : row + _STRIPE], self.encoding)
            made[row : row + _STRIPE] = through(part, matrix)
        return made

    def numbers(self, light: Light) -> Light:
        """Inverse of :meth:`light`."""
        if self.is_plain:
            return light
        own = through(light, np.linalg.inv(np.array(rec709_from(self.encoding))))
        return curved(own, self.encoding)


PLAIN = Colors()


def _keeps_white(encoding: Encoding) -> bool:
    return bool(np.allclose(encoding.scene_white, LINEAR.white, rtol=0, atol=2e-4))


def of_exr(facts: Mapping[str, Any], names: tuple[str, ...] = ()) -> Colors:
    """Colours that the header of an OpenEXR file states.

    Args:
        facts: Values of its attributes.
        names: Channels of its colour; X, Y and Z are CIE XYZ, a single one is grey.
    """
    stated, remarks = _stated(facts)
    if len(set(names)) == 1:  # grey is grey by any primaries
        stated = {by: Encoding(space.srgb, space.gamma) for by, space in stated.items()}
    if tuple(name.rpartition(".")[2].upper() for name in names) == ("X", "Y", "Z"):
        return Colors(XYZ_D65, "channels X, Y, Z", tuple(remarks))
    if not stated:
        return Colors(remarks=tuple(remarks))
    (by, first), *others = stated.items()
    for other, encoding in others:
        if encoding != first and not _alike(encoding, first):
            remarks.append(f"{other} says {title_of(encoding)}, but {by} counts")
    return Colors(first, by, tuple(remarks))


def _stated(facts: Mapping[str, Any]) -> tuple[dict[str, Encoding], list[str]]:
    """Encodings by the attributes that state them, in order of precedence; and remarks."""
    found: dict[str, Encoding] = {}
    remarks: list[str] = []
    if facts.get(FLAG) == 1:
        found[FLAG] = encoding_of_space("aces")
    by_id = facts.get(ID)
    if isinstance(by_id, str) and is_data(by_id):
        return {ID: LINEAR}, [f"{ID} says data: no colors are converted"]
    _name(by_id, ID, found, remarks)
    if CORNERS in facts:
        try:
            found[CORNERS] = _of_corners(facts[CORNERS])
        except ValueError as error:
            text = short(facts[CORNERS])
            remarks.append(f"{CORNERS} {text} are not followed: {error}; read as linear Rec.709")
    if not found:
        for name, value in facts.items():
            if name.lower() in _NAMES and not found and not is_data(str(value)):
                _name(value, name, found, remarks)
    return found, remarks


def _name(value: object, by: str, found: dict[str, Encoding], remarks: list[str]) -> None:
    """Adds the encoding of a named space, or a remark that its name is unknown."""
    if not isinstance(value, str) or not value.strip():
        return
    if value.strip().lower() == "unknown":
        remarks.append(f"{by} says that the color space is unknown")
        return
    encoding = encoding_in_file(value)
    if encoding is None:
        remarks.append(f"{by} {short(value)} is an unknown color space")
    else:
        found[f"{by} {short(value)}"] = encoding


def _of_corners(value: object) -> Encoding:
    if not isinstance(value, tuple) or len(value) != 8:
        raise ValueError("wanted 8 numbers")
    r, g, b, w = ((float(value[i]), float(value[i + 1])) for i in range(0, 8, 2))
    return encoding_of_primaries((r, g, b), w)


def _alike(one: Encoding, other: Encoding) -> bool:
    """Whether two statements have the same primaries, and scene white, to the digits of files."""
    same = np.allclose(one.primaries, other.primaries, rtol=0, atol=1e-3)
    return bool(same and np.allclose(one.scene_white, other.scene_white, rtol=0, atol=1e-3))


def of_primaries(values: tuple[float, ...], by: str, *, is_xyz: bool = False) -> Colors:
    """Colours of x and y of red, green, blue and white.

    Args:
        values: Eight numbers.
        by: Attribute that states them.
        is_xyz: Whether the numbers of the file are XYZ, for which only the white counts.
    """
    r, g, b, w = ((values[i], values[i + 1]) for i in range(0, 8, 2))
    try:
        encoding = encoding_of_primaries((r, g, b), w)
    except ValueError as error:
        text = f"{by} {short(values)} is not followed: {error}; read as linear Rec.709"
        return Colors(remarks=(text,))
    if is_xyz:
        encoding = replace(XYZ_D65, neutral=w)
    return Colors(encoding, by)
