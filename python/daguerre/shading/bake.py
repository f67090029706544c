"""Computes pictures from pictures, texel by texel, within a budget.

Pictures with equal mappings are combined texel by texel; the result is exact up to the filter
between texels. Smaller pictures are resampled to the size of the largest. Pictures with other
mappings are replaced by their mean, with a note.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.files.notes import Notes

from .channels import (
    Channel,
    Coordinate,
    Mapping,
    Plane,
    Texel,
    UnsupportedError,
    Value,
    VertexColor,
)

#: Limit on the bytes of all computed pictures of a stage, as a small graph could ask for many.
MAX_BYTES = 2 << 30
_OTHER_MAPPING = "combined pictures with different mappings use the mean of the second"
_TOO_LARGE = "a picture computed from others is too large: their means are combined"


class Canvas(Protocol):
    """Texels of a surface on which all that is known about it can be computed."""

    def placed(self, channel: Channel) -> Channel:
        """Resamples coordinates, or a picture with another mapping, to texels of the canvas."""

    def vector(self, name: str) -> Value | None:
        """Three-dimensional coordinates by name, such as positions; None: unknown."""

    def measure(self, point: Value, texels: float) -> None:
        """Notes that a cell of a pattern at these coordinates needs a number of texels."""


class Baker:
    """Computes channels, and counts their bytes.

    Args:
        notes: Receives notes on approximations.
        limit: Most bytes of computed pictures.
        canvas: Texels that combine coordinates, and pictures of different mappings; None: they are
            not combined.
    """

    def __init__(self, notes: Notes, limit: int = MAX_BYTES, canvas: Canvas | None = None) -> None:
        self.notes = notes
        self.canvas = canvas
        self._left = limit

    def combined(self, function: Callable[..., Any], *channels: Channel) -> Channel:
        """Applies a function of numbers to channels.

        Args:
            function: Function that takes numbers or arrays (H, W), one for each channel.
            channels: Arguments of the function.

        Raises:
            UnsupportedError: A channel is no number and no picture.
        """
        return self.several(lambda *values: (function(*values),), 1, *channels)[0]

    def several(
        self, function: Callable[..., Any], count: int, *channels: Channel
    ) -> tuple[Channel, ...]:
        """Applies a function with several results; see ``combined``."""
        channels = self.together(channels)
        for channel in channels:
            if isinstance(channel, Coordinate):
                raise UnsupportedError("arithmetic on texture coordinates that is not affine")
            if isinstance(channel, VertexColor):
                raise UnsupportedError("arithmetic on colours of vertices")
        pictures = [channel for channel in channels if isinstance(channel, Texel)]
        if not pictures:
            return _numbers(
                function, [channel for channel in channels if isinstance(channel, float)]
            )
        mapping = pictures[0].mapping
        size = _largest([picture for picture in pictures if picture.mapping == mapping])
        if not self._affords(size, count):
            return _numbers(function, [self._mean(channel, None) for channel in channels])
        arguments = [self._values(channel, mapping, size) for channel in channels]
        with np.errstate(all="ignore"):
            results = function(*arguments)
        name = pictures[0].plane.name
        return tuple(Texel(Plane(_finite(values, size), name=name), mapping) for values in results)

    def together(self, channels: Sequence[Channel]) -> tuple[Channel, ...]:
        """Channels with one mapping, if there is a canvas."""
        if self.canvas is None:
            return tuple(channels)
        mappings = {channel.mapping for channel in channels if isinstance(channel, Texel)}
        if len(mappings) < 2 and not any(isinstance(c, Coordinate) for c in channels):
            return tuple(channels)
        return tuple(self.canvas.placed(channel) for channel in channels)

    def resampled(self, channel: Channel, mapping: Mapping, size: tuple[int, int]) -> Channel:
        """Picture of a given size and mapping; a number stays a number."""
        if not isinstance(channel, Texel) or channel.mapping != mapping:
            return self._mean(channel, mapping)
        if channel.plane.pixels.shape == size:
            return channel
        if not self._affords(size):
            return channel.mean()
        values = resized(channel.plane.linear(), size, mapping.wrap)
        plane = Plane(freeze_in_place(values), name=channel.plane.name)
        return Texel(plane, mapping, channel.scale, channel.bias)

    def _values(self, channel: Channel, mapping: Mapping, size: tuple[int, int]) -> Any:
        if isinstance(channel, Texel) and channel.mapping == mapping:
            values = channel.values()
            return values if values.shape == size else resized(values, size, mapping.wrap)
        return np.float32(self._mean(channel, mapping))

    def _mean(self, channel: Channel, mapping: Mapping | None) -> float:
        if isinstance(channel, Texel):
            self.notes.add(_OTHER_MAPPING if mapping is not None else _TOO_LARGE)
            return channel.mean()
        return channel if isinstance(channel, float) else 0.0

    def _affords(self, size: tuple[int, int], count: int = 1) -> bool:
        needed = size[0] * size[1] * 4 * count
        if needed > self._left:
            self.notes.add(_TOO_LARGE)
            return False
        self._left -= needed
        return True


def resized(
    values: NDArray[np.float32], size: tuple[int, int], wrap: tuple[str, str]
) -> NDArray[np.float32]:
    """Resamples a picture (H, W) to another size between texel centres, by bilinear filter."""
    for axis, (count, how) in enumerate(zip(size, (wrap[1], wrap[0]), strict=True)):
        had = values.shape[axis]
        if had == count:
            continue
        at = (np.arange(count) + 0.5) * (had / count) - 0.5
        first = np.floor(at).astype(np.int64)
        share = (at - first).astype(np.float32)
        share = share[:, None] if axis == 0 else share[None, :]
        low, high = _index(first, had, how), _index(first + 1, had, how)
        lower, upper = np.take(values, low, axis), np.take(values, high, axis)
        values = lower + share * (upper - lower)
    return np.ascontiguousarray(values, np.float32)


def _index(index: NDArray[np.int64], count: int, wrap: str) -> NDArray[np.int64]:
    """Index of a texel beyond a border: on the opposite side, or at the border."""
    return index % count if wrap == "repeat" else np.clip(index, 0, count - 1)


def _largest(pictures: list[Texel]) -> tuple[int, int]:
    heights, widths = zip(*(picture.plane.pixels.shape for picture in pictures), strict=True)
    return max(heights), max(widths)


def _finite(values: object, size: tuple[int, int]) -> NDArray[np.float32]:
    """Picture of values, 0 where they are not finite."""
    whole = np.broadcast_to(np.asarray(values, np.float32), size)
    finite = np.nan_to_num(whole, nan=0.0, posinf=0.0, neginf=0.0)
    return freeze_in_place(np.ascontiguousarray(finite))


def _numbers(function: Callable[..., Any], numbers: list[float]) -> tuple[float, ...]:
    with np.errstate(all="ignore"):
        found = [float(result) for result in function(*(np.float64(number) for number in numbers))]
    return tuple(result if np.isfinite(result) else 0.0 for result in found)
