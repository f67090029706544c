"""Textures as trees: each node has a color at texture coordinates.

Colors are linear Rec.709, shape (..., 3); numbers have three equal components.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb

from .texture_mapping import Mapping, UvMapping

Array = NDArray[np.floating]
_WHOLE = UvMapping()


@dataclass(frozen=True, eq=False)
class Constant:
    """One color everywhere."""

    color: tuple[float, float, float]

    def at(self, s: Array, t: Array) -> Array:
        """The color, at coordinates of any shape."""
        return np.broadcast_to(np.array(self.color, np.float32), (*s.shape, 3))


@dataclass(frozen=True, eq=False)
class Image:
    """A picture: ``scale`` x its value, or 1 minus that.

    Attributes:
        pixels: Shape (H, W, C), uint8 or float32, row 0 on top.
        curve: ``srgb``, or the exponent of its values.
        mapping: Mapping to surfaces.
        wrap: Values beyond its edges: repeat, clamp or black.
        filter: ``linear`` or ``nearest``.
        scale: Factor.
        invert: Whether the value is 1 minus that.
        grey: Whether the mean of its channels counts.
        name: Name of its file.
    """

    pixels: NDArray[np.uint8] | NDArray[np.float32]
    curve: str | float
    mapping: Mapping
    wrap: str = "repeat"
    filter: str = "linear"
    scale: float = 1.0
    invert: bool = False
    grey: bool = False
    name: str = ""

    @property
    def is_plain(self) -> bool:
        """Whether the pixels can be shown as they are, times ``scale``."""
        color = self.pixels.shape[2] >= 3
        known = self.curve == 1.0 or (self.curve == "srgb" and self.pixels.dtype == np.uint8)
        return known and not self.invert and not (self.grey and color) and self.wrap != "black"

    @cached_property
    def linear(self) -> Array:
        """All values, shape (H, W, 3), without ``scale`` and ``invert``."""
        colors = self.pixels[:, :, :3] if self.pixels.shape[2] >= 3 else self.pixels[:, :, :1]
        if colors.dtype == np.uint8:
            decoded = self._decoded(np.arange(256, dtype=np.float32) / 255)[colors]
        else:
            decoded = self._decoded(colors.astype(np.float32, copy=False))
        if self.grey:
            decoded = decoded.mean(axis=2, keepdims=True)
        return np.broadcast_to(decoded, (*decoded.shape[:2], 3))

    def _decoded(self, values: Array) -> Array:
        if self.curve == "srgb":
            return np.asarray(srgb.to_linear(values), np.float32)
        if self.curve == 1.0:
            return values
        return np.asarray(np.maximum(values, 0) ** np.float32(self.curve), np.float32)

    def texels(self) -> Array:
        """Colors of all pixels, shape (H, W, 3)."""
        return self._scaled(self.linear)

    def _scaled(self, values: Array) -> Array:
        found = values * np.float32(self.scale)
        found = np.maximum(1 - found if self.invert else found, 0)
        return np.asarray(found, np.float32)

    def at(self, s: Array, t: Array) -> Array:
        """Colors at coordinates of the picture, between pixels linear or the nearest."""
        values = self.linear
        height, width = values.shape[:2]
        x, y = s * width - 0.5, (1 - t) * height - 0.5
        if self.filter == "nearest":
            found = self._pixels(values, np.round(x), np.round(y))
        else:
            left, top = np.floor(x), np.floor(y)
            across, down = (x - left)[..., None], (y - top)[..., None]
            upper = self._row(values, left, top, across)
            found = upper + (self._row(values, left, top + 1, across) - upper) * down
        return self._scaled(found)

    def _row(self, values: Array, left: Array, row: Array, across: Array) -> Array:
        first = self._pixels(values, left, row)
        return np.asarray(first + (self._pixels(values, left + 1, row) - first) * across)

    def _pixels(self, values: Array, x: Array, y: Array) -> Array:
        height, width = values.shape[:2]
        columns, rows = x.astype(np.int64), y.astype(np.int64)
        inside = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
        if self.wrap == "repeat":
            return np.asarray(values[rows % height, columns % width])
        found = values[np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)]
        return found * inside[..., None] if self.wrap == "black" else found


@dataclass(frozen=True, eq=False)
class Product:
    """Product of two textures."""

    first: Node
    second: Node


@dataclass(frozen=True, eq=False)
class Blend:
    """Mixture of two textures; ``amount`` is the share of the second."""

    first: Node
    second: Node
    amount: Node


@dataclass(frozen=True, eq=False)
class Checkerboard:
    """Squares of size 1 in s and t, of two textures in turn."""

    mapping: Mapping
    first: Node
    second: Node


@dataclass(frozen=True, eq=False)
class Bilinear:
    """Linear between the colors v00, v10, v01 and v11 of the corners of [0, 1]^2 in s and t."""

    mapping: Mapping
    corners: tuple[tuple[float, float, float], ...]


Node = Constant | Image | Product | Blend | Checkerboard | Bilinear


def mappings(node: Node) -> Iterator[Mapping]:
    """Mappings of a tree."""
    if isinstance(node, Image | Checkerboard | Bilinear):
        yield node.mapping
    for part in parts(node):
        yield from mappings(part)


def parts(node: Node) -> tuple[Node, ...]:
    """Nodes below a node."""
    if isinstance(node, Product | Checkerboard):
        return node.first, node.second
    return (node.first, node.second, node.amount) if isinstance(node, Blend) else ()


def evaluated(node: Node, u: Array, v: Array, common: Mapping | None) -> Array:
    """Colors of a tree, shape (..., 3).

    Args:
        node: The tree.
        u: Texture coordinates; with ``common``: coordinates s of that mapping.
        v: The same along v, or t.
        common: Mapping of all its textures; None: each has a mapping of texture coordinates.
    """
    if isinstance(node, Constant):
        return node.at(u, v)
    if isinstance(node, Product):
        first, second = (evaluated(part, u, v, common) for part in (node.first, node.second))
        return np.asarray(first * second)
    if isinstance(node, Blend):
        first, second, amount = (evaluated(part, u, v, common) for part in parts(node))
        return np.asarray(first + (second - first) * amount)
    assert common is not None or isinstance(node.mapping, UvMapping)
    s, t = (u, v) if common is not None else _uv(node.mapping, u, v)
    if isinstance(node, Image):
        return node.at(s, t)
    if isinstance(node, Bilinear):
        corners = np.array(node.corners, np.float32)
        weights = np.stack([(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t], axis=-1)
        return np.asarray(weights @ corners, np.float32)
    even = (np.floor(s) + np.floor(t)) % 2 == 0
    first, second = (evaluated(part, u, v, common) for part in parts(node))
    return np.where(even[..., None], first, second)


def _uv(mapping: Mapping, u: Array, v: Array) -> tuple[Array, Array]:
    uv = mapping if isinstance(mapping, UvMapping) else _WHOLE
    s, t = uv.at(u.astype(np.float64), v.astype(np.float64))
    return s.astype(np.float32), t.astype(np.float32)
