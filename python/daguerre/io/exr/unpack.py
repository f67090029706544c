"""Deflated pixels of OpenEXR as plain ones, by libdeflate; nothing else touches their bytes."""

from __future__ import annotations

import deflate
import numpy as np
from numpy.typing import NDArray

from daguerre import _core


def inflated(data: bytes, size: int) -> NDArray[np.uint8]:
    """The bytes of a block.

    Args:
        data: Those of the file; plain where deflating would not have paid.
        size: Bytes of the pixels, at least one.

    Raises:
        ValueError: They are damaged, or of another size.
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
