# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes: the picture, and channels by their own names, as Blender's arrays."""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.frame.aovs import BY_NAME, Aov
from daguerre.frame.frame import Frame

from .translation import Shot

COMBINED = "Combined"


def asked(scene: Any) -> list[Aov]:
    """Groups of channels that a scene of Blender asks for, in the order of their table."""
    return [row for name, row in BY_NAME.items() if name in scene.daguerre.passes]


def registered(scene: Any) -> Iterator[tuple[str, int, str, str]]:
    """Passes as ``register_pass`` takes them: name, number of channels, letters and kind."""
    yield COMBINED, 4, "RGBA", "COLOR"
    for row in asked(scene):
        letters = row.parts or "X"
        kind = "COLOR" if letters == "RGB" else "VECTOR" if len(letters) == 3 else "VALUE"
        yield row.name, len(letters), letters, kind


def combined(frame: Frame, shot: Shot) -> NDArray[np.float32]:
    """Picture in Blender's brightness, premultiplied, shape (H, W, 4).

    Blender's film is opaque unless it is set to transparent.
    """
    has_holes = shot.is_transparent and frame.alpha.size > 0
    alpha = frame.alpha if has_holes else np.ones_like(frame.rgb[..., 0])
    return np.dstack([frame.rgb * np.float32(shot.factor), alpha]).astype(np.float32)


def plane(frame: Frame, row: Aov) -> NDArray[np.float32] | None:
    """Channels of a group, shape (H, W, C); None: the frame has none."""
    if any(channel not in frame.aovs for channel in row.channels):
        return None
    return np.dstack([frame.aovs[channel] for channel in row.channels]).astype(np.float32)


def planes(frame: Frame, rows: Iterable[Aov], shot: Shot) -> Iterator[tuple[str, Any]]:
    """All passes of a frame, by name."""
    yield COMBINED, combined(frame, shot)
    for row in rows:
        if (found := plane(frame, row)) is not None:
            yield row.name, found


def flat(pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """Pixels in Blender's order: the bottom row first, one after the other."""
    return np.ascontiguousarray(pixels[::-1]).reshape(-1)
