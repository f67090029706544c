"""Elements of Mitsuba's scene format."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np

from daguerre.exporters.outgoing.folder import OutgoingFolder
from daguerre.exporters.outgoing.picture_file import write_pixels
from daguerre.exporters.outgoing.pictures import IDENTITY, BakedPicture, Colored, Number
from daguerre.exporters.outgoing.spectra import samples
from daguerre.files.notes import Notes
from daguerre.scene.spectrum import Spectrum

Element = ElementTree.Element


def add(parent: Element, tag: str, **attributes: str) -> Element:
    """Adds an element with its attributes, except empty ones."""
    return ElementTree.SubElement(parent, tag, {k: v for k, v in attributes.items() if v})


def add_value(parent: Element, tag: str, name: str, value: object) -> Element:
    """Adds a number, a boolean or a text by name."""
    text = str(value).lower() if isinstance(value, bool) else _text(value)
    return add(parent, tag, name=name, value=text)


def add_matrix(parent: Element, name: str, matrix: object) -> None:
    """Adds a transform, rows of a 4x4 matrix that acts on columns."""
    transform = add(parent, "transform", name=name)
    add(transform, "matrix", value=numbers(np.asarray(matrix, np.float64).reshape(-1).tolist()))


def add_rgb(parent: Element, name: str, color: Sequence[float]) -> None:
    """Adds a linear Rec.709 colour."""
    add(parent, "rgb", name=name, value=numbers(color))


def add_point(parent: Element, tag: str, name: str, point: Any) -> None:
    """Adds a ``point`` or a ``vector``."""
    x, y, z = (_text(float(v)) for v in point)
    add(parent, tag, name=name, x=x, y=y, z=z)


def numbers(values: Sequence[float]) -> str:
    """Joins numbers, each with all of its digits."""
    return ", ".join(_text(float(v)) for v in values)


def with_comment(text: str, comment: str) -> str:
    """Puts a comment before the root element."""
    return f"<!-- {comment} -->\n{text}"


class Values:
    """Adds values that may be constant or pictures."""

    def __init__(self, folder: OutgoingFolder, notes: Notes) -> None:
        self._folder, self._notes = folder, notes

    def color(self, parent: Element, name: str, value: Colored) -> None:
        """Adds a colour, a spectrum or a bitmap."""
        if isinstance(value, BakedPicture):
            self.bitmap(parent, name, value, raw=False)
        elif isinstance(value, Spectrum):
            pairs = ", ".join(f"{_text(nm)}:{_text(v)}" for nm, v in samples(value))
            add_value(parent, "spectrum", name, pairs)
        else:
            add_rgb(parent, name, value)

    def factor(self, parent: Element, name: str, value: Colored) -> None:
        """Adds a factor on light; above 1 Mitsuba refuses an ``rgb`` of a surface."""
        if isinstance(value, BakedPicture | Spectrum) or max(value) <= 1:
            self.color(parent, name, value)
            return
        bright = add(parent, "spectrum", type="srgb", name=name)
        add_rgb(bright, "color", value)
        add_value(bright, "boolean", "unbounded", True)

    def number(self, parent: Element, name: str, value: Number) -> None:
        """Adds a number or a bitmap."""
        if isinstance(value, BakedPicture):
            self.bitmap(parent, name, value, raw=True)
        else:
            add_value(parent, "float", name, float(value))

    def bitmap(self, parent: Element, name: str, picture: BakedPicture, *, raw: bool) -> None:
        """Adds a bitmap; ``raw``: its numbers are no colours."""
        if picture.wrap[0] != picture.wrap[1]:  # Mitsuba has one mode for both axes
            picture = picture.without_mirrors()
        wrap = picture.wrap[0]
        if picture.wrap[1] != wrap:
            self._notes.add(f"texture with two wrap modes has {wrap} for both")
        texture = add(parent, "texture", type="bitmap", name=name)
        add_value(
            texture,
            "string",
            "filename",
            write_pixels(self._folder, "texture", coded(picture, raw)),
        )
        add_value(texture, "string", "wrap_mode", wrap)
        add_value(texture, "string", "filter_type", "nearest" if picture.nearest else "bilinear")
        add_value(texture, "boolean", "raw", raw)
        if picture.transform != IDENTITY:
            a, b, c, d, e, f = picture.transform
            add_matrix(texture, "to_uv", [[a, b, 0, c], [d, e, 0, f], [0, 0, 1, 0], [0, 0, 0, 1]])


def coded(picture: BakedPicture, raw: bool) -> Any:
    """Pixels as a file that Mitsuba decodes to the same values.

    Mitsuba takes 8-bit pixels for sRGB unless they are raw, so linear pixels become floats.
    """
    keeps = picture.pixels.dtype == np.uint8 and picture.srgb != raw
    return picture.pixels if keeps else picture.linear


def _text(value: object) -> str:
    return repr(float(value)) if isinstance(value, float) else str(value)
