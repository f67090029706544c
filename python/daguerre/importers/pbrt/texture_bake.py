"""Makes pictures of trees of textures.

Where all textures of a tree share a mapping, the picture spans one period of that mapping, so that
it repeats as they do. Otherwise it spans the texture coordinates 0 to 1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes

from .texture_mapping import Mapping, SpaceMapping, UvMapping
from .texture_nodes import Bilinear, Checkerboard, Constant, Image, Node, evaluated, mappings, parts

Array = NDArray[np.floating]
Curve = Callable[[Array], Array]
#: Largest side of a picture of several textures.
_MOST = 2048
#: Side of a picture of smooth values without pictures in them.
_SMOOTH = 64
_ROWS = 64


@dataclass(frozen=True, eq=False)
class Baked:
    """A picture of a tree.

    Attributes:
        pixels: Shape (H, W, 3), float32, row 0 on top.
        mapping: Mapping of the picture.
        period: Size in s and t that it spans.
        filter: ``linear`` or ``nearest``.
        wrap: ``repeat`` or ``clamp``.
    """

    pixels: Array
    mapping: Mapping
    period: float
    filter: str
    wrap: str


def baked(node: Node, curve: Curve | None, notes: Notes) -> Baked:
    """Makes a picture of a tree.

    Args:
        node: The tree, not a constant.
        curve: Function of all values, or None.
        notes: Receives a note if the picture differs from the tree.
    """
    common = _common(node, notes)
    mapping: Mapping = UvMapping() if common is None else common
    leaves = list(_leaves(node))
    sharp = all(isinstance(leaf, Constant | Checkerboard) for leaf in leaves)
    period = 2.0 if any(isinstance(leaf, Checkerboard) for leaf in leaves) and common else 1.0
    width, height = _size(leaves, common is None, period)
    nearest = sharp and common is not None
    if nearest:
        width = height = 2
    if isinstance(node, Image):
        pixels = node.texels()
    else:
        pixels = _drawn(node, (width, height), period, common)
    made = pixels if curve is None else np.asarray(curve(pixels), np.float32)
    images = [leaf for leaf in leaves if isinstance(leaf, Image)]
    clamped = bool(images) and all(image.wrap != "repeat" for image in images)
    if any(image.wrap == "black" for image in images):
        notes.add("a texture with wrap mode black is clamped when combined")
    return Baked(
        made, mapping, period, "nearest" if nearest else "linear", "clamp" if clamped else "repeat"
    )


def _drawn(node: Node, size: tuple[int, int], period: float, common: Mapping | None) -> Array:
    """Colors of a tree at the middles of pixels, shape (H, W, 3)."""
    width, height = size
    pixels = np.empty((height, width, 3), np.float32)
    s = (np.arange(width, dtype=np.float32) + 0.5) / width * period
    for row in range(0, height, _ROWS):
        rows = np.arange(row, min(row + _ROWS, height), dtype=np.float32)
        t = (1 - (rows + 0.5) / height) * period
        u, v = np.meshgrid(s, t)
        pixels[row : row + len(rows)] = evaluated(node, u, v, common)
    return pixels


def mean(node: Node) -> tuple[float, float, float]:
    """Mean color of a tree, each texture over its period."""
    if isinstance(node, Constant):
        return node.color
    grid = (np.arange(64, dtype=np.float32) + 0.5) / 32
    u, v = np.meshgrid(grid, grid)
    colors = evaluated(node, u, v, UvMapping()).reshape(-1, 3).mean(axis=0)
    red, green, blue = (float(value) for value in colors)
    return red, green, blue


def _common(node: Node, notes: Notes) -> Mapping | None:
    found = list(mappings(node))
    first = found[0]
    if all(mapping is first or mapping == first for mapping in found):
        return first
    if any(isinstance(mapping, SpaceMapping) for mapping in found):
        notes.add("combined textures with different mappings share one mapping")
        return first
    if not all(isinstance(mapping, UvMapping) and mapping.repeats for mapping in found):
        notes.add("combined textures with different scales repeat with scale 1")
    return None


def _leaves(node: Node) -> Iterator[Node]:
    """Constants, images and patterns of a tree."""
    if isinstance(node, Constant | Image | Checkerboard | Bilinear):
        yield node
    for part in parts(node):
        yield from _leaves(part)


def _size(leaves: list[Node], own: bool, period: float) -> tuple[int, int]:
    """Width and height of a picture that shows all pixels of its parts, up to a limit."""
    widths, heights = [2.0], [2.0]
    for leaf in leaves:
        if isinstance(leaf, Image):
            height, width = leaf.pixels.shape[:2]
        elif isinstance(leaf, Bilinear):
            width = height = _SMOOTH
        elif isinstance(leaf, Checkerboard) and own:
            width = height = _SMOOTH // 4
        else:
            continue
        across, down = 1.0, 1.0
        if own and isinstance(leaf.mapping, UvMapping):
            across, down = leaf.mapping.scale
        widths.append(width * max(abs(across), 1.0) * period)
        heights.append(height * max(abs(down), 1.0) * period)
    return min(round(max(widths)), _MOST), min(round(max(heights)), _MOST)
