"""Reads the first part of an OpenEXR file, with its windows and attributes."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from daguerre.checks import MAX_RESOLUTION
from daguerre.errors import InputError
from daguerre.files.json_item import clean
from daguerre.files.reading import opened

from .header import MAGIC
from .layout import read_layouts
from .parts import PartReader


class ExrReader(PartReader):
    """Reader of the first part of a file.

    Attributes:
        header: Header of the part.
        facts: Values of its attributes, by name.
        corner: First pixel of the data window, px.
        full_corner: First pixel of the display window, px.
        full_size: Width and height of the display window, px.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Opens a file.

        Raises:
            InputError: The file cannot be read, or a window is missing, empty or too large.
        """
        layout = read_layouts(Path(path), 0)[0]
        self.path = layout.path
        self.header = layout.header
        self.facts = self.header.facts
        self._window("dataWindow")
        self.corner = layout.box[:2]
        x0, y0, x1, y1 = self._window("displayWindow")
        self.full_corner, self.full_size = (x0, y0), (x1 - x0 + 1, y1 - y0 + 1)
        super().__init__(layout)

    def _window(self, name: str) -> tuple[int, int, int, int]:
        box = self.facts.get(name)
        if not (isinstance(box, tuple) and self.header.attributes[name][0] == "box2i"):
            raise InputError(f"{self.path}: header: {name}: missing, or not a box2i")
        x0, y0, x1, y1 = box
        width, height = x1 - x0 + 1, y1 - y0 + 1
        if not (1 <= width <= MAX_RESOLUTION and 1 <= height <= MAX_RESOLUTION):
            raise InputError(
                f"{self.path}: {name}: wanted 1 to {MAX_RESOLUTION} pixels each way, "
                f"got {width} x {height}"
            )
        return x0, y0, x1, y1


def is_exr(path: str | os.PathLike[str]) -> bool:
    """Whether a file begins like OpenEXR, whatever its name; False if it cannot be read."""
    try:
        with opened(path) as stream:
            return stream.read(4) == MAGIC.to_bytes(4, "little")
    except (InputError, OSError):
        return False


def refuse_chroma(names: Sequence[str], where: str) -> None:
    """Refuses luminance with chroma: luminance alone would lose the colours.

    Raises:
        InputError: Channels are Y, RY and BY.
    """
    if {"Y", "RY", "BY"} <= set(names):
        raise InputError(
            f"{where}: channels: wanted R, G, B or one grey, got luminance and chroma (Y, RY, BY)"
        )


def light_names(names: Sequence[str], where: str) -> list[str]:
    """Finds the channels of red, green and blue, or X, Y and Z, or a grey channel three times.

    Channels without a layer come first; else all three come from one layer. X, Y and Z without a
    layer are colours (CIE XYZ); in a layer they are places or directions.

    Args:
        names: Names of all channels.
        where: The file, for messages.

    Raises:
        InputError: The file has none of these.
    """
    layers = sorted(
        {name.rpartition(".")[0] for name in names}, key=lambda name: (name != "", name)
    )
    plain = {name.lower(): name for name in reversed(names)}
    for layer in layers:
        wanted = [f"{layer}.{color}".lstrip(".").lower() for color in "RGB"]
        if all(name in plain for name in wanted):
            return [plain[name] for name in wanted]
    if all(name in plain for name in "xyz"):
        return [plain[name] for name in "xyz"]
    refuse_chroma(names, where)
    grey = [name for name in names if name.rpartition(".")[2].upper() in ("Y", "I", "L")]
    if not grey and len(names) > 1:
        got = ", ".join(clean(name) for name in names[:8])
        raise InputError(f"{where}: channels: wanted R, G, B or one grey, got {got}")
    return [(grey or list(names))[0]] * 3
