"""A grid of numbers in space, as stored in a file."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import FixedArrays

#: Maximum number of values, 2 GB.
MAX_VALUES = 1 << 29


@dataclass(frozen=True, eq=False)
class FileGrid(FixedArrays):
    """Values at the centres of the cells of a box.

    Attributes:
        values: Shape (Z, Y, X, C), C channels.
        transform: From the unit cube, which the cells fill, to the space of the file, shape (4, 4).
        name: Name in the file.
    """

    values: NDArray[np.float32]
    transform: NDArray[np.float64]
    name: str = ""

    def __repr__(self) -> str:
        z, y, x, channels = self.values.shape
        return f"<FileGrid {self.name!r}: {x} x {y} x {z} cells, {channels} channels>"
