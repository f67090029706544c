"""Unpacks deflated pixels of OpenEXR by libdeflate."""

from __future__ import annotations

import deflate
import numpy as np
from numpy.typing import NDArray

from daguerre import _core


def inflated(data: bytes, size: int) -> NDArray[np.uint8]:
    """Unpacks a block.

    Args:
        data: Bytes in the file; plain pixels if deflating did not make them smaller.
        size: Bytes of the pixels, at least one.

    Raises:
        ValueError: The data are damaged, or give another size.
    """
    if len(data) == size:
        return np.frombuffer(data, np.uint8)
    try:
        plain = deflate.zlib_decompress(data, size)
    except deflate.DeflateError:
        raise ValueError(f"damaged pixels: wanted a zlib stream of {size} bytes") from None
    if len(plain) != size:
        raise ValueError(f"wanted {size} bytes of pixels, got {len(plain)}")
    pixels = np.empty(size, np.uint8)
    _core.undo_exr_predictor(np.frombuffer(plain, np.uint8), pixels)
    return pixels
