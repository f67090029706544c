"""A decoded picture of a texture."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.pictures.stated_colors import PLAIN, Colors

from .channels import IDENTITY, Plane, Six


@dataclass(frozen=True, eq=False)
class DecodedPicture:
    """A decoded picture.

    Attributes:
        pixels: Shape (H, W, 1..4), uint8 or float32, row 0 on top.
        name: Name of its file.
        transform: Transform from texture coordinates to picture coordinates, for UDIM.
        tiled: Whether it was stitched from tiles.
        colors: Colour encoding that the file states.
    """

    pixels: NDArray[Any]
    name: str
    transform: Six = IDENTITY
    tiled: bool = False
    colors: Colors = PLAIN

    @property
    def is_light(self) -> bool:
        """Whether colours are in linear Rec.709, or sRGB, already; grey is grey in every space."""
        return self.colors.is_plain or self.pixels.shape[2] < 3

    def light(self) -> DecodedPicture:
        """The picture with colours converted to linear Rec.709 from the file's encoding."""
        made = self.pixels.astype(np.float32)
        made[:, :, :3] = self.colors.light(made[:, :, :3])
        return replace(self, pixels=freeze_in_place(made), colors=PLAIN)

    def planes(self, *, srgb: bool) -> tuple[Plane, Plane, Plane, Plane | None]:
        """Red, green, blue and opacity; ``srgb``: the colours are encoded by sRGB's curve."""
        count = self.pixels.shape[2]
        colors = (0, 1, 2) if count > 2 else (0, 0, 0)
        r, g, b = (self._plane(index, srgb) for index in colors)
        return r, g, b, self._plane(count - 1, False) if count in (2, 4) else None

    def _plane(self, index: int, srgb: bool) -> Plane:
        return Plane(self.pixels[:, :, index], srgb, self.pixels, index, self.name)
