"""Splits pictures of any number of channels for code that takes four at a time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .picture import Image


def by_four_channels(image: Image, spread: Callable[[Image], Image]) -> Image:
    """Applies ``spread`` to a picture (H, W, C), four channels at a time; returns (rows, W, C).

    Args:
        image: Picture with any number of channels.
        spread: Function from (H, W, 4) to (rows, W, 4) that does not mix channels.
    """
    parts = []
    count = image.shape[2]
    for begin in range(0, count, 4):
        part = image[:, :, begin : begin + 4]
        missing = 4 - part.shape[2]
        if missing:
            part = np.pad(part, ((0, 0), (0, 0), (0, missing)))
        parts.append(spread(np.ascontiguousarray(part, np.float32)))
    whole = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=2)
    return whole[:, :, :count]
