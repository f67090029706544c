"""A photograph as in its file: upright pixels and metadata of the shot."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb
from daguerre.files.reading import opened
from daguerre.files.value import BriefRecord

Kind = Literal["raw", "display", "linear"]
XY = tuple[float, float]


@dataclass(frozen=True, eq=False, repr=False)
class RawNumbers(BriefRecord):
    """Digital numbers of a mosaic, upright.

    Attributes:
        mosaic: Digital numbers of the photosites, uint16, shape (H, W).
        cells: Channel index of each photosite of the repeating cell, shape (h, w).
        channels: Names of the channels, ``("R", "G", "B")`` or ``("Y",)``.
        black: DN without light by channel, shape (C,).
        white: DN from which on a photosite is saturated.
        white_balance: White balance of the camera, chromaticity (x, y).
    """

    mosaic: NDArray[np.uint16]
    cells: NDArray[np.uint8]
    channels: tuple[str, ...]
    black: NDArray[np.float64]
    white: int
    white_balance: XY


@dataclass(frozen=True, eq=False, repr=False)
class Photograph(BriefRecord):
    """A photograph.

    Attributes:
        path: Path of its file.
        kind: ``raw``: values of a mosaic; ``display``: display-encoded; ``linear``: linear light.
        pixels: Red, green and blue, upright, shape (H, W, 3): uint8 or uint16 for ``display``,
            float32 for ``linear``; None for ``raw``.
        raw: Values of the mosaic for ``raw``; else None.
        facts: Metadata of the shot by OpenEXR's names, such as ``expTime`` (s), ``aperture``.
        notes: Assumptions made on reading, a sentence each.
    """

    path: Path
    kind: Kind
    pixels: NDArray[Any] | None
    raw: RawNumbers | None
    facts: dict[str, Any]
    notes: tuple[str, ...] = ()

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the upright picture, px."""
        shape = self._array.shape
        return int(shape[1]), int(shape[0])

    @property
    def _array(self) -> NDArray[Any]:
        array = self.pixels if self.raw is None else self.raw.mosaic
        assert array is not None
        return array

    def linear(
        self, rows: slice = slice(None), columns: slice = slice(None)
    ) -> NDArray[np.float32]:
        """Returns linear light of a part of a developed photograph, shape (h, w, 3)."""
        part = self._array[rows, columns]
        if self.kind == "linear":
            return np.asarray(part, np.float32)
        return np.asarray(srgb.to_linear(encoded(part)), np.float32)

    def sha256(self) -> str:
        """SHA-256 of the file."""
        with opened(self.path) as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()


def encoded(pixels: NDArray[Any]) -> NDArray[np.float32]:
    """Scales integer pixels to 0 .. 1; float pixels are not changed."""
    if not np.issubdtype(pixels.dtype, np.integer):
        return np.asarray(pixels, np.float32)
    scaled = pixels.astype(np.float32)
    scaled /= np.float32(np.iinfo(pixels.dtype).max)
    return scaled
