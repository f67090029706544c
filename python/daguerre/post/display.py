"""A picture for the eye of what the darkroom made."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np
from numpy.typing import NDArray

from daguerre.frame import Frame

from .picture import Image


class Display:
    """Collects rows in 8 bits, and writes a PNG: sRGB, clipped at 1, as ``Frame.save`` does."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._rows: list[NDArray[np.uint8]] = []

    def write(self, image: Image, alpha: bool) -> None:
        """The next rows, shape (rows, W, C); the last channel may be alpha, which is left out."""
        colours = image[:, :, : image.shape[2] - alpha]
        rgb = np.broadcast_to(colours, (*colours.shape[:2], 3))
        self._rows.append(Frame(np.ascontiguousarray(rgb)).display())

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        tb: TracebackType | None,
    ) -> None:
        if kind is None:
            from daguerre.io.png import write_pixels

            write_pixels(self._path, np.concatenate(self._rows))
