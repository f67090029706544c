"""A small writer of NanoVDB grids of single-precision numbers, version 32.

It places nodes as OpenVDB's own does (grid, tree, root, its tiles, upper nodes, lower nodes,
leaves), by dictionaries instead of arrays, so that it shares no code with the reader.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping, Sequence

Cell = tuple[int, int, int]
GRID, TREE, ROOT, TILE, UPPER, LOWER, LEAF = 672, 64, 64, 32, 270400, 33856, 2144
VERSION = 32 << 21 | 6 << 10


class Writer:
    """A grid with values of single cells, and of blocks of 8, 128 or 4096 cells.

    Args:
        cells: Active values by cell.
        blocks: Active values by first cell and size.
        background: Value elsewhere.
    """

    def __init__(
        self,
        cells: Mapping[Cell, float],
        blocks: Mapping[tuple[Cell, int], float] | None = None,
        background: float = 0.0,
    ) -> None:
        self.background = background
        self.tree: dict[Cell, dict[Cell, dict[Cell, dict[Cell, float]]]] = {}
        self.blocks = dict(blocks or {})
        for (cell, size), _ in self.blocks.items():
            if size < 4096:
                lower = self.tree.setdefault(_floor(cell, 4096), {})
                if size < 128:
                    lower.setdefault(_floor(cell, 128), {})
        for cell, value in cells.items():
            lower = self.tree.setdefault(_floor(cell, 4096), {}).setdefault(_floor(cell, 128), {})
            lower.setdefault(_floor(cell, 8), {})[cell] = value

    def bytes(
        self,
        matrix: Sequence[float] = (1, 0, 0, 0, 1, 0, 0, 0, 1),
        origin: Sequence[float] = (0, 0, 0),
        name: str = "density",
        **facts: int,
    ) -> bytes:
        """The grid; ``facts`` are ``kind`` (of grid), ``type`` and ``version``."""
        roots = [*self.tree, *(cell for (cell, size) in self.blocks if size == 4096)]
        uppers = list(self.tree)
        lowers = [(u, cell) for u in uppers for cell in self.tree[u]]
        leaves = [(u, w, cell) for u, w in lowers for cell in self.tree[u][w]]
        at_upper = GRID + TREE + ROOT + TILE * len(roots)
        at_lower = at_upper + UPPER * len(uppers)
        at_leaf = at_lower + LOWER * len(lowers)
        data = bytearray(at_leaf + LEAF * len(leaves))
        self._head(data, matrix, origin, name, facts)
        root = GRID + TREE
        struct.pack_into(
            "<QQQQ", data, GRID, at_leaf - GRID, at_lower - GRID, at_upper - GRID, TREE
        )
        struct.pack_into("<If", data, root + 24, len(roots), self.background)
        for i, cell in enumerate(roots):
            child = at_upper + UPPER * uppers.index(cell) - root if cell in self.tree else 0
            value = self.blocks.get((cell, 4096), 0.0)
            key = sum(((c & 0xFFFFFFFF) >> 12) << s for c, s in zip(cell, (42, 21, 0), strict=True))
            struct.pack_into("<QqIf", data, root + ROOT + TILE * i, key, child, not child, value)
        for i, upper in enumerate(uppers):
            places = {cell: at_lower + LOWER * lowers.index((upper, cell))
                      for cell in self.tree[upper]}  # fmt: skip
            self._inner(data, at_upper + UPPER * i, upper, (5, 128, 8256), places)
        for i, (upper, lower) in enumerate(lowers):
            places = {cell: at_leaf + LEAF * leaves.index((upper, lower, cell))
                      for cell in self.tree[upper][lower]}  # fmt: skip
            self._inner(data, at_lower + LOWER * i, lower, (4, 8, 1088), places)
        for i, (upper, lower, leaf) in enumerate(leaves):
            self._leaf(data, at_leaf + LEAF * i, leaf, self.tree[upper][lower][leaf])
        return bytes(data)

    def _head(
        self,
        data: bytearray,
        matrix: Sequence[float],
        origin: Sequence[float],
        name: str,
        facts: Mapping[str, int],
    ) -> None:
        data[:8] = b"NanoVDB1"
        struct.pack_into("<I", data, 16, facts.get("version", VERSION))
        struct.pack_into("<Q", data, 32, len(data))
        data[40 : 40 + len(name)] = name.encode()
        struct.pack_into("<9d", data, 296 + 88, *matrix)
        struct.pack_into("<3d", data, 296 + 232, *origin)
        struct.pack_into("<II", data, 632, facts.get("kind", 2), facts.get("type", 1))

    def _inner(
        self,
        data: bytearray,
        at: int,
        corner: Cell,
        level: tuple[int, int, int],
        places: Mapping[Cell, int],
    ) -> None:
        """An inner node: logarithm of entries, cells of an entry, offset of its table."""
        log, cells, table = level
        mask = (1 << 3 * log) // 8
        for n in range(1 << 3 * log):
            struct.pack_into("<f", data, at + table + 8 * n, self.background)
        for cell, place in places.items():
            n = _entry(cell, corner, log, cells)
            data[at + 32 + mask + n // 8] |= 1 << n % 8
            struct.pack_into("<q", data, at + table + 8 * n, place - at)
        for (cell, size), value in self.blocks.items():
            if size == cells and _floor(cell, cells << log) == corner:
                n = _entry(cell, corner, log, cells)
                data[at + 32 + n // 8] |= 1 << n % 8
                struct.pack_into("<f", data, at + table + 8 * n, value)

    def _leaf(self, data: bytearray, at: int, corner: Cell, cells: Mapping[Cell, float]) -> None:
        for n in range(512):
            struct.pack_into("<f", data, at + 96 + 4 * n, self.background)
        for cell, value in cells.items():
            n = _entry(cell, corner, 3, 1)
            data[at + 16 + n // 8] |= 1 << n % 8
            struct.pack_into("<f", data, at + 96 + 4 * n, value)


def segment(grids: Sequence[tuple[str, bytes]], codec: int = 0) -> bytes:
    """A segment of a file with grids by name, plain (0), zipped (1) or by BLOSC (2)."""
    head = b"NanoVDB2" + struct.pack("<IHH", VERSION, len(grids), codec)
    metas, bodies = b"", b""
    for name, grid in grids:
        packed = grid
        if codec == 1:
            small = zlib.compress(grid)
            packed = struct.pack("<Q", len(small)) + small
        meta = bytearray(176)
        struct.pack_into("<QQ", meta, 0, len(grid), len(packed))
        struct.pack_into("<I", meta, 136, len(name) + 1)
        struct.pack_into("<H", meta, 168, codec)
        metas += bytes(meta) + name.encode() + b"\0"
        bodies += packed
    return head + metas + bodies


def _floor(cell: Cell, size: int) -> Cell:
    x, y, z = (c // size * size for c in cell)
    return x, y, z


def _entry(cell: Cell, corner: Cell, log: int, cells: int) -> int:
    x, y, z = ((a - b) // cells for a, b in zip(cell, corner, strict=True))
    return x << 2 * log | y << log | z
