"""Pictures for effects: bands of rows, and facts about the whole.

Positions are in px of the display window: x to the right, y down, (0, 0) its top left corner, so
that the centre of its first pixel is (0.5, 0.5). Rows are counted from the first row of pixels.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from daguerre.convolution.rows import Rows

Image = NDArray[np.float32]


@dataclass(frozen=True)
class Canvas:
    """Facts about a picture before its pixels are read.

    Attributes:
        width: Width of the data window, px.
        height: Height of the data window, px.
        corner: First pixel of the data window in the display window, px.
        full_size: Width and height of the display window, px, on which effects are centred.
        colors: Names of the color channels; the last may be alpha.
        planes: Names of all other channels, as in the file.
        facts: Attributes of the file by name.
        where: Name of the picture, for messages.
        roles: Channels for "depth", "motion.u", "motion.v" that have unusual names.
    """

    width: int
    height: int
    corner: tuple[int, int] = (0, 0)
    full_size: tuple[int, int] = (0, 0)
    colors: tuple[str, ...] = ("R", "G", "B")
    planes: tuple[str, ...] = ()
    facts: Mapping[str, Any] = field(default_factory=dict)
    where: str = "picture"
    roles: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.full_size == (0, 0):
            object.__setattr__(self, "full_size", (self.width, self.height))

    @property
    def alpha(self) -> bool:
        """Whether the last of the colours is alpha."""
        return self.colors[-1] == "A"

    @property
    def center(self) -> tuple[float, float]:
        """Centre of the display window, px."""
        return 0.5 * self.full_size[0], 0.5 * self.full_size[1]

    @classmethod
    def of(cls, shape: tuple[int, ...], planes: tuple[str, ...], where: str) -> Canvas:
        """Returns the facts of an array of shape (H, W, C): 1 or 3 colours, one more is alpha."""
        height, width, count = shape
        names = {1: ("Y",), 2: ("Y", "A"), 3: ("R", "G", "B"), 4: ("R", "G", "B", "A")}
        colors = names.get(count, tuple(f"C{k}" for k in range(count)))
        return cls(width, height, colors=colors, planes=planes, where=where)


@dataclass(frozen=True)
class Band:
    """Some rows of a picture.

    Attributes:
        rows: Rows of the band.
        image: Scene-linear colours, and alpha if the picture has it: float32 (rows, W, C). Must not
            be changed in place.
        planes: Other channels by name, (rows, W), in the types of the file.
    """

    rows: Rows
    image: Image
    planes: Mapping[str, NDArray[Any]] = field(default_factory=dict)

    def cut(self, rows: Rows) -> Band:
        """Returns some of its rows."""
        if rows == self.rows:
            return self
        part = slice(rows.begin - self.rows.begin, rows.end - self.rows.begin)
        planes = {name: plane[part] for name, plane in self.planes.items()}
        return Band(rows, self.image[part], planes)

    def with_image(self, image: Image) -> Band:
        """Returns the band with other colours."""
        return replace(self, image=np.ascontiguousarray(image, np.float32))


class RowSource(Protocol):
    """Interface of a picture that can be read by rows."""

    @property
    def canvas(self) -> Canvas:
        """Facts about the picture."""

    def rows(self, rows: Rows) -> Band:
        """Returns these rows; all must be in the picture."""


def bands(source: RowSource, height: int) -> Iterator[Band]:
    """Yields all rows of a picture from top to bottom, ``height`` at a time."""
    for begin in range(0, source.canvas.height, height):
        yield source.rows(Rows(begin, min(begin + height, source.canvas.height)))
