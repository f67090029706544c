"""Ghosts on the way: a layer of live ghosts for each picture, drawn by the same camera."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from functools import lru_cache, reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.frame.frame import Frame
from daguerre.rendering.live_ghosts import LiveGhosts
from daguerre.rendering.session import Session

#: Longest time to draw a layer, s. The second layer of a lens also builds the caches, and takes
#: twice as long as the first.
MOST_S = 1.0
#: Pause in the layers of a lens after a layer that took longer, s.
PAUSE_S = 10.0


class Layers:
    """Draws layers, unless the lens has been too slow for them of late."""

    def __init__(self) -> None:
        self._ghosts = LiveGhosts()
        self._slow: Any = None  # lens
        self._pause_end = -math.inf

    def draw(self, session: Session) -> Layer | None:
        """Draws the ghosts of a session's picture; None: there are none, or they are too slow."""
        lens, begun = session.camera.lens, time.monotonic()
        if lens == self._slow and begun < self._pause_end:
            return None
        try:
            light = self._ghosts.draw(session)
        finally:  # whoever lost patience cancelled it
            ended = time.monotonic()
            slow = ended - begun > MOST_S
            if slow:
                self._slow, self._pause_end = lens, ended + PAUSE_S
        return None if light is None or slow else Layer(session, light)


@dataclass(frozen=True)
class Layer:
    """Ghosts of a picture, maybe at another size.

    Attributes:
        session: Session of a picture of the layer's size; it has drawn nothing.
        light: Their light.
    """

    session: Session
    light: Frame

    def added(self, frame: Frame) -> Frame:
        """Returns a frame with the ghosts, at its own size."""
        light = resized(_stacked(self.light), frame.width, frame.height)
        return replace(_split(frame, _stacked(frame) + light), flare=light[..., :3])

    def sharp(self, frame: Frame) -> Frame | None:
        """Returns a frame with the ghosts, at the size of the layer; None: that is no larger."""
        size = self.light.width, self.light.height
        if size[0] <= frame.width:
            return None
        alpha = resized(frame.alpha[..., None], *size)[..., 0]
        one = self.session.prepared
        facts = {**frame.metadata, "resolution": one.size, "crop": one.crop}
        light = replace(self.light, alpha=alpha, metadata=facts)
        values = _stacked(light) + resized(_stacked(frame), *size)
        return self.session.exposed(_split(light, values))


def _stacked(frame: Frame) -> NDArray[np.float32]:
    """Colours and channels of a frame side by side, (H, W, N)."""
    if frame.channels is None:
        return frame.rgb
    return np.concatenate([frame.rgb, frame.channels], axis=2)


def _split(frame: Frame, values: NDArray[np.float32]) -> Frame:
    """Returns a frame with other values, side by side as ``_stacked`` puts them."""
    channels = None if frame.channels is None else values[..., 3:]
    return replace(frame, rgb=values[..., :3], xyz=None, channels=channels)


def resized(values: NDArray[np.float32], width: int, height: int) -> NDArray[np.float32]:
    """Resizes values, (H, W, N), by a triangle filter, as wide as the larger pixels."""
    return _along(_along(values, 0, height), 1, width)


def _along(values: NDArray[np.float32], axis: int, after: int) -> NDArray[np.float32]:
    """Resizes an axis; a matrix would wake the threads of BLAS, which take longer to sleep."""
    if values.shape[axis] == after:
        return values
    shape = (-1, 1, 1) if axis == 0 else (-1, 1)
    places, weights = _taps(values.shape[axis], after)
    taps = zip(places, weights, strict=True)
    parts = (values.take(place, axis) * weight.reshape(shape) for place, weight in taps)
    return np.asarray(reduce(np.add, parts), np.float32)


@lru_cache(16)
def _taps(before: int, after: int) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """Source pixels of each new pixel, and their weights, both (taps, after)."""
    reach = max(1.0, before / after)
    centres = (np.arange(after) + 0.5) * (before / after) - 0.5
    places = np.floor(centres - reach).astype(int) + np.arange(1, math.ceil(2 * reach) + 1)[:, None]
    weights = np.clip(1 - np.abs(places - centres) / reach, 0, None)
    weights[(places < 0) | (places >= before)] = 0
    return np.clip(places, 0, before - 1), np.asarray(weights / weights.sum(axis=0), np.float32)
