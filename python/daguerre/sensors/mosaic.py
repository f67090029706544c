"""Colour filter arrays: the channel of each photosite."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import short
from daguerre.errors import UsageError, suggest
from daguerre.files.value import BriefRecord, Value

#: Rows of the repeating cell, by name; the first letter is the top left photosite of a picture.
PATTERNS = {
    "mono": ("Y",),
    "bayer-rggb": ("RG", "GB"),
    "bayer-bggr": ("BG", "GR"),
    "bayer-grbg": ("GR", "BG"),
    "bayer-gbrg": ("GB", "RG"),
    "quad-bayer-rggb": ("RRGG", "RRGG", "GGBB", "GGBB"),
    # Two rows of colour in three have green at 5 of 9 photosites, so that every row and column
    # has all three (Fujifilm, US 8456553 B2, figure 1).
    "xtrans": ("GGRGGB", "GGBGGR", "BRGRBG", "GGBGGR", "GGRGGB", "RBGBRG"),
}


@guarded
@dataclass(frozen=True, eq=False, repr=False)
class Mosaic(Value, BriefRecord):
    """A colour filter array.

    Attributes:
        name: ``bayer-rggb``, ``bayer-bggr``, ``bayer-grbg``, ``bayer-gbrg``, ``quad-bayer-rggb``,
            ``xtrans`` or ``mono``.
        cells: Channel index of each photosite of the cell, which repeats from the top left corner,
            shape (h, w).
    """

    name: str
    cells: NDArray[np.uint8]

    @classmethod
    def of(cls, name: str, channels: tuple[str, ...], where: str = "sensor") -> Mosaic:
        """Returns the pattern of a name, for a sensor's channels.

        Raises:
            UsageError: The pattern is unknown, or needs channels that the sensor lacks.
        """
        if name not in PATTERNS:
            raise UsageError(
                f"{where}: pattern: wanted one of {', '.join(PATTERNS)}, got {short(name)}"
                f"{suggest(str(name), PATTERNS)}"
            )
        rows = PATTERNS[name]
        letters = sorted(set("".join(rows)))
        if set(letters) != set(channels):
            raise UsageError(
                f"{where}: pattern: {name}: wanted a sensor with channels {', '.join(letters)}, "
                f"got {', '.join(one[:40] for one in channels)}"
            )
        cells = [[channels.index(letter) for letter in row] for row in rows]
        return cls(name, np.array(cells, np.uint8))

    @property
    def shares(self) -> NDArray[np.float64]:
        """Share of the photosites of each channel, shape (C,)."""
        return np.bincount(self.cells.ravel()) / self.cells.size

    def neighbors(self) -> NDArray[np.float64]:
        """Share of channel j among the four neighbours of channel i, shape (C, C)."""
        count = int(self.cells.max()) + 1
        out = np.zeros((count, count))
        for axis in (0, 1):
            for step in (-1, 1):
                np.add.at(out, (self.cells, np.roll(self.cells, step, axis)), 1)
        return np.asarray(out / out.sum(axis=1, keepdims=True))

    def channel_map(self, height: int, width: int) -> NDArray[np.uint8]:
        """Channel index of every photosite, shape (height, width)."""
        rows, columns = self.cells.shape
        tiles = (-(-height // rows), -(-width // columns))
        return np.tile(self.cells, tiles)[:height, :width]
