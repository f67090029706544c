"""Values of shading: one to four channels, each a number, a picture, or a coordinate.

Sums and products with numbers are kept as factors, so that a picture keeps the numbers of its file.
Everything else between pictures is computed for each texel (:mod:`.bake`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb as srgb_curve

#: Numbers of one channel of a node: one number, or an array of any shape.
Numbers = NDArray[np.floating] | np.floating | float
Six = tuple[float, float, float, float, float, float]
IDENTITY: Six = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)


class UnsupportedError(Exception):
    """A value that cannot be represented; the text is the remark for the user."""


@dataclass(frozen=True, eq=False)
class Plane:
    """One channel of a picture.

    Attributes:
        pixels: Shape (H, W), uint8 or float32, row 0 on top.
        srgb: Whether values are encoded by sRGB's curve.
        source: Picture with all channels, shape (H, W, C), with this plane as channel ``index``.
        name: Name of the file.
    """

    pixels: NDArray[np.uint8] | NDArray[np.float32]
    srgb: bool = False
    source: NDArray[np.uint8] | NDArray[np.float32] | None = None
    index: int = 0
    name: str = ""

    @property
    def key(self) -> tuple[int, bool]:
        """Identity of the values, while the plane lives."""
        owner = self.pixels if self.source is None else self.source
        return id(owner) * 8 + self.index, self.srgb

    def linear(self) -> NDArray[np.float32]:
        """Decoded values, shape (H, W)."""
        if self.pixels.dtype != np.uint8:
            values = self.pixels.astype(np.float32, copy=False)
            return _decoded(values) if self.srgb else values
        table = np.arange(256, dtype=np.float32) / np.float32(255)
        return np.asarray((_decoded(table) if self.srgb else table)[self.pixels], np.float32)


@dataclass(frozen=True)
class Mapping:
    """Mapping of a picture to a surface.

    Attributes:
        primvar: Name of the texture coordinates, with (0, 0) at the bottom left.
        transform: Affine transform of these coordinates, by rows.
        wrap: Wrapping along s and t.
        filter: Filter of magnification.
        min_filter: Filter of minification, with the names of ``Scene.add_texture``.
    """

    primvar: str = "st"
    transform: Six = IDENTITY
    wrap: tuple[str, str] = ("repeat", "repeat")
    filter: str = "linear"
    min_filter: str = "linear_mipmap_linear"


@dataclass(frozen=True)
class Texel:
    """Channel of a picture on a surface: ``scale`` x value + ``bias``."""

    plane: Plane
    mapping: Mapping
    scale: float = 1.0
    bias: float = 0.0

    def values(self) -> NDArray[np.float32]:
        """Values of all texels, shape (H, W)."""
        decoded = self.plane.linear()
        if (self.scale, self.bias) == (1.0, 0.0):
            return decoded
        return decoded * np.float32(self.scale) + np.float32(self.bias)

    def mean(self) -> float:
        """Mean over the picture."""
        return float(self.plane.linear().mean(dtype=np.float64)) * self.scale + self.bias


@dataclass(frozen=True)
class Coordinate:
    """Affine function of texture coordinates: a s + b t + c."""

    primvar: str
    a: float
    b: float
    c: float


@dataclass(frozen=True)
class VertexColor:
    """Channel 0 .. 3 of colours at the vertices, times ``scale``."""

    primvar: str
    channel: int
    scale: float = 1.0


Channel = float | Texel | Coordinate | VertexColor
Value = tuple[Channel, ...]


def coordinates(primvar: str) -> Value:
    """Texture coordinates as they are."""
    return Coordinate(primvar, 1.0, 0.0, 0.0), Coordinate(primvar, 0.0, 1.0, 0.0)


def fit(value: Value, size: int) -> Value:
    """Changes the number of channels: repeats a single channel, adds opacity, drops the last."""
    if len(value) == 1:
        alike = value * min(size, 3)
        return (*alike, 1.0)[:size] if size == 4 else alike
    return (*value, *(0.0, 0.0, 0.0, 1.0)[len(value) : size])[:size]


def broadcast(value: Value, size: int) -> Value:
    """Repeats a single channel; other sizes are fitted."""
    return value * size if len(value) == 1 else fit(value, size)


def numbers_of(value: Value) -> tuple[float, ...] | None:
    """Numbers of a value; None: some channel is none."""
    if all(isinstance(channel, float) for channel in value):
        return tuple(channel for channel in value if isinstance(channel, float))
    return None


def scaled(channel: Channel, factor: float) -> Channel:
    """Product of a channel and a number."""
    if isinstance(channel, float):
        return channel * factor
    if factor == 0.0:
        return 0.0
    if isinstance(channel, Texel):
        return replace(channel, scale=channel.scale * factor, bias=channel.bias * factor)
    if isinstance(channel, Coordinate):
        return replace(channel, a=channel.a * factor, b=channel.b * factor, c=channel.c * factor)
    return replace(channel, scale=channel.scale * factor)


def shifted(channel: Channel, offset: float) -> Channel:
    """Sum of a channel and a number."""
    if isinstance(channel, float):
        return channel + offset
    if offset == 0.0:
        return channel
    if isinstance(channel, Texel):
        return replace(channel, bias=channel.bias + offset)
    if isinstance(channel, Coordinate):
        return replace(channel, c=channel.c + offset)
    raise UnsupportedError("arithmetic on colours of vertices")


def same(a: Value, b: Value) -> bool:
    """Whether two values are the same picture, or the same numbers."""
    return len(a) == len(b) and all(_alike(x, y) for x, y in zip(a, b, strict=True))


def _alike(a: Channel, b: Channel) -> bool:
    if isinstance(a, Texel) and isinstance(b, Texel):
        rest = (a.mapping, a.scale, a.bias) == (b.mapping, b.scale, b.bias)
        return rest and a.plane.key == b.plane.key
    return type(a) is type(b) and a == b


def texels(channels: Sequence[Channel]) -> list[Texel]:
    """Channels that are pictures."""
    return [channel for channel in channels if isinstance(channel, Texel)]


def _decoded(values: NDArray[np.float32]) -> NDArray[np.float32]:
    return np.asarray(srgb_curve.to_linear(values), np.float32)
