"""Pixels of an image of Blender."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color.srgb import to_linear

Picture = NDArray[np.float32]
#: Colour spaces whose bytes are linear.
LINEAR = ("Non-Color", "Linear Rec.709", "Linear", "Raw")


def pixels_of(image: Any) -> Picture | None:
    """Scene-linear picture, shape (H, W, 3), row 0 on top; None: there are no pixels.

    Bytes of another colour space than sRGB are taken as linear. Blender itself converts pictures of
    floats when it reads them.
    """
    if image is None or not all(image.size) or not image.channels:
        return None
    columns, rows = image.size
    flat = np.empty(columns * rows * image.channels, np.float32)
    image.pixels.foreach_get(flat)
    picture = flat.reshape(rows, columns, image.channels)[::-1, :, :3]
    if picture.shape[2] < 3:
        picture = np.repeat(picture[..., :1], 3, axis=2)
    if not image.is_float and image.colorspace_settings.name == "sRGB":
        return np.asarray(to_linear(picture), np.float32)
    return np.ascontiguousarray(picture)
