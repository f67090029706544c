"""A developed picture."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.color import spaces
from daguerre.files import formats
from daguerre.files.array_value import ArrayValue

from .shown import Shown

if TYPE_CHECKING:
    import os


@guarded
@dataclass(eq=False)
class Picture(ArrayValue, Shown, array="pixels"):
    """A developed picture, encoded for display.

    NumPy takes it for its ``pixels``.

    Attributes:
        pixels: Red, green and blue, encoded with the transfer curve of the colour space, 0 to 1,
            float32, shape (H, W, 3); in a linear space light, of any value.
        colour_space: ``srgb``, ``p3`` (Display P3) or ``rec2020``; linear: ``lin_rec709``,
            ``acescg``, ``aces``, ``xyz`` or ``camera``.
        metadata: Data of the shot, for EXIF.
    """

    pixels: NDArray[np.float32]
    colour_space: str = "srgb"
    metadata: dict[str, Any] = field(default_factory=dict)

    @property
    def width(self) -> int:
        """Columns, px."""
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        """Rows, px."""
        return int(self.pixels.shape[0])

    def linear(self) -> NDArray[np.float32]:
        """Linear light in the primaries of the colour space, shape (H, W, 3)."""
        return spaces.decoded(self.pixels, self.colour_space)

    def bytes8(self) -> NDArray[np.uint8]:
        """Pixels in 8 bits, shape (H, W, 3)."""
        return quantized(self.pixels, 8)

    def save(
        self, path: str | os.PathLike[str], *, quality: int = 95, bits: int | None = None
    ) -> None:
        """Writes the picture atomically, with its colour profile and EXIF.

        Args:
            path: ``.jpg``, ``.png``, ``.tif`` or ``.exr`` (linear).
            quality: JPEG quality, 1 to 100.
            bits: Bits per channel, 8 or 16; default: 16 for TIFF, 8 for others.

        Raises:
            UsageError: Another suffix, a bit depth that the format lacks, or linear light in a
                format for displays.
            OutputError: The file cannot be written.
        """
        formats.write("picture", path, self, quality=quality, bits=bits)

    def _shown(self) -> Picture:
        """The picture for a screen: light is encoded as sRGB, clipped at 1."""
        if self.colour_space in spaces.ENCODED:
            return self
        light = np.clip(_rec709(self.pixels, self.colour_space).astype(np.float64), 0, 1)
        return Picture(np.asarray(spaces.encoded(light, "srgb"), np.float32), "srgb", self.metadata)

    def __repr__(self) -> str:
        return f"<Picture {self.width}x{self.height}, {self.colour_space}>"


def _rec709(pixels: NDArray[np.float32], space: str) -> NDArray[np.float32]:
    """Linear Rec.709 of linear light in a space; a camera's colours stay."""
    from daguerre.color.encodings import encoding_of_space, rec709_from, through

    if space == spaces.CAMERA:
        return pixels
    return through(pixels, np.array(rec709_from(encoding_of_space(space))))


def quantized(pixels: NDArray[np.float32], bits: int) -> NDArray[Any]:
    """Rounds 0 .. 1 to integers of 8 or 16 bits, in strips of rows to save memory."""
    top = np.float32(2**bits - 1)
    out = np.empty(pixels.shape, np.uint8 if bits == 8 else np.uint16)
    for row in range(0, len(pixels), 64):
        part = np.nan_to_num(pixels[row : row + 64], nan=0.0)
        out[row : row + 64] = np.clip(part, 0, 1) * top + np.float32(0.5)
    return out
