"""Pixels of an image of Blender."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daguerre.color.srgb import to_linear

if TYPE_CHECKING:
    import bpy


Picture = NDArray[np.float32]
#: Colour spaces with linear bytes.
LINEAR = ("Non-Color", "Linear Rec.709", "Linear", "Raw")


def raw_pixels(image: bpy.types.Image) -> Picture | None:
    """Pixels as Blender has them, shape (H, W, C), row 0 on top; None: they cannot be loaded."""
    count = len(image.pixels)  # loads the image
    width, height = (int(n) for n in image.size)
    channels = int(image.channels)
    if not count or count != width * height * channels:
        return None
    flat = np.empty(count, np.float32)
    image.pixels.foreach_get(flat)
    return flat.reshape(height, width, channels)[::-1]


def pixels_of(image: bpy.types.Image) -> Picture | None:
    """Scene-linear picture, shape (H, W, 3), row 0 on top; None: there are no pixels.

    Bytes of another colour space than sRGB are taken as linear. Blender itself converts pictures of
    floats when it reads them.
    """
    pixels = None if image is None else raw_pixels(image)
    if pixels is None:
        return None
    picture = pixels[:, :, :3]
    if picture.shape[2] < 3:
        picture = np.repeat(picture[..., :1], 3, axis=2)
    if not image.is_float and image.colorspace_settings.name == "sRGB":
        return np.asarray(to_linear(picture), np.float32)
    return np.ascontiguousarray(picture)
