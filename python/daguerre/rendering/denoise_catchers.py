"""Denoising of catcher layers: light added and light taken, separately.

The denoiser needs values of at least 0, and a change of light can be negative. Filtered separately,
both parts keep their means, and so does their difference.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

Image = NDArray[np.float32]

#: Layers, and the value that means no change.
_NEUTRAL = {
    "catcher": 0.0,
    "catcher_ratio": 1.0,
    "catcher_channels": 0.0,
    "catcher_ratio_channels": 1.0,
}
#: Reach of a change in pixels: beyond it the plate keeps its bits.
REACH = 8


def clean_catchers(frame: Frame, clean: Callable[[Image], Image]) -> dict[str, Any]:
    """Denoises the catcher layers of a frame; returns them by name, empty if it has none.

    Args:
        frame: The noisy picture.
        clean: Filter for pictures (H, W, 3) of at least 0.
    """
    made: dict[str, Any] = {}
    for name, neutral in _NEUTRAL.items():
        layer: Image | None = getattr(frame, name)
        if layer is not None:
            change = np.nan_to_num(layer - np.float32(neutral))
            made[name] = np.asarray(_change(change, clean) + np.float32(neutral), np.float32)
            if neutral:
                np.maximum(made[name], 0, out=made[name])
    return made


def _change(change: Image, clean: Callable[[Image], Image]) -> Image:
    """Denoises a change, shape (H, W, C); 0 far from pixels with a change."""
    parts = [np.maximum(sign * change, 0) for sign in (1, -1)]
    more, less = (_of_channels(part, clean) if part.any() else part for part in parts)
    near = _near(np.asarray(change.any(axis=2)))
    return np.where(near[..., None], more - less, np.float32(0))


def _of_channels(light: Image, clean: Callable[[Image], Image]) -> Image:
    """Filters light of any number of channels: three together, any other number one at a time."""
    if light.shape[2] == 3:
        return clean(light)
    alone = [clean(np.repeat(light[..., c, None], 3, axis=2)) for c in range(light.shape[2])]
    return np.stack([image.mean(axis=2) for image in alone], axis=2)


def _near(changed: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Mask of pixels with a change in the square of ``REACH`` around them."""
    found = changed
    for axis in (0, 1):
        wide = np.pad(found, [(REACH, REACH) if a == axis else (0, 0) for a in (0, 1)])
        windows = np.lib.stride_tricks.sliding_window_view(wide, 2 * REACH + 1, axis)
        found = np.asarray(windows.any(axis=2))
    return found
