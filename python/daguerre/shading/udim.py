"""Stitches UDIM tiles to one picture.

Tile 1001 + u + 10 v covers texture coordinates u .. u + 1, v .. v + 1 (v upward). The picture
covers the smallest rectangle around the tiles; smaller tiles are enlarged to the largest, and tiles
that are missing are black. If the whole would be too large, all tiles are halved until it fits.

Source: OpenUSD, UsdUVTexture (https://openusd.org/release/spec_usdpreviewsurface.html).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .bake import resized
from .channels import Six

MARK = "<UDIM>"
FIRST, LAST = 1001, 1999
#: Limit on the bytes of a stitched picture.
MAX_BYTES = 1 << 30
Pixels = NDArray[Any]


@dataclass(frozen=True)
class Grid:
    """Rectangle of tiles: its first column and row, and the number of both."""

    u: int
    v: int
    columns: int
    rows: int

    @property
    def transform(self) -> Six:
        """Transform from texture coordinates to coordinates of the stitched picture."""
        across, up = 1 / self.columns, 1 / self.rows
        return across, 0.0, -self.u * across, 0.0, up, -self.v * up


def tile_numbers(names: list[str], pattern: str) -> dict[int, str]:
    """Tiles in a folder, with names of a pattern such as ``wood.<UDIM>.png``, by number."""
    before, after = pattern.split(MARK, 1)
    form = re.compile(re.escape(before) + r"(\d{4})" + re.escape(after) + r"\Z")
    found = {int(match[1]): name for name in names if (match := form.match(name))}
    return {number: found[number] for number in sorted(found) if FIRST <= number <= LAST}


def grid_of(numbers: list[int]) -> Grid:
    """Smallest rectangle that holds all tiles."""
    columns = [(number - FIRST) % 10 for number in numbers]
    rows = [(number - FIRST) // 10 for number in numbers]
    u, v = min(columns), min(rows)
    return Grid(u, v, max(columns) - u + 1, max(rows) - v + 1)


def stitched(tiles: Mapping[int, Pixels], limit: int = MAX_BYTES) -> tuple[Pixels, Grid, bool]:
    """Stitches tiles.

    Args:
        tiles: Pixels (H, W, 1..4), uint8 or float32, by number.
        limit: Most bytes of the result.

    Returns:
        Pixels, their grid, and whether tiles were halved to stay within the limit.
    """
    grid = grid_of(list(tiles))
    floats = any(tile.dtype != np.uint8 for tile in tiles.values())
    height, width, channels = (
        max(tile.shape[axis] for tile in tiles.values()) for axis in range(3)
    )
    halved = False
    each = channels * (4 if floats else 1) * grid.columns * grid.rows
    while height * width * each > limit and max(height, width) > 1:
        height, width, halved = max(height // 2, 1), max(width // 2, 1), True
    whole = np.zeros(
        (grid.rows * height, grid.columns * width, channels), np.float32 if floats else np.uint8
    )
    for number, tile in tiles.items():
        column = (number - FIRST) % 10 - grid.u
        row = grid.rows - 1 - ((number - FIRST) // 10 - grid.v)  # row 0 is on top
        part = whole[row * height : (row + 1) * height, column * width : (column + 1) * width]
        part[...] = _alike(tile, (height, width), channels, floats)
    return whole, grid, halved


def _alike(tile: Pixels, size: tuple[int, int], channels: int, floats: bool) -> Pixels:
    """Converts a tile to the common size, number of channels and type."""
    if tile.shape[2] in (1, 2) and channels > 2:
        grey = np.repeat(tile[:, :, :1], 3, axis=2)
        tile = np.concatenate([grey, tile[:, :, 1:]], axis=2)
    if tile.shape[2] < channels:
        full = 255 if tile.dtype == np.uint8 else 1
        opaque = np.full((*tile.shape[:2], channels - tile.shape[2]), full, tile.dtype)
        tile = np.concatenate([tile, opaque], axis=2)
    if floats and tile.dtype == np.uint8:
        tile = tile.astype(np.float32) / np.float32(255)
    if tile.shape[:2] == size:
        return tile
    tile = _shrunk(tile, size)
    planes = [
        resized(tile[:, :, c].astype(np.float32), size, ("clamp", "clamp")) for c in range(channels)
    ]
    whole = np.stack(planes, axis=2)
    return whole if floats else np.rint(whole).astype(np.uint8)


def _shrunk(tile: Pixels, size: tuple[int, int]) -> Pixels:
    """Means of blocks, as long as the tile is at least twice as large."""
    for axis, wanted in enumerate(size):
        times = tile.shape[axis] // wanted
        if times >= 2:
            part = np.take(tile, range(wanted * times), axis).astype(np.float32)
            shape = list(part.shape)
            shape[axis : axis + 1] = [wanted, times]
            tile = part.reshape(shape).mean(axis=axis + 1)
    return tile
