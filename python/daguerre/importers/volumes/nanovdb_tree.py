"""Trees of NanoVDB as dense grids.

A root has tiles of 4096 cells along each axis. A tile is one value or an upper node of 32^3
entries, each one value or a lower node of 16^3 entries, each one value or a leaf of 8^3 cells. A
node is at an offset, in bytes, from its parent node.

Source: OpenVDB, ``nanovdb/PNanoVDB.h``, version 32: offsets in grids of single-precision numbers.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.errors import InputError
from daguerre.importers.file_bytes import Bytes, check_room, most_unpacked

from .grid import MAX_VALUES, FileGrid

Integers = NDArray[np.int64]
_MAGIC = (b"NanoVDB0", b"NanoVDB1")
_VERSION, _FLOAT, _LEVEL_SET = 32, 1, 1


def _layout(size: int, **fields: tuple[int, Any]) -> np.dtype[np.void]:
    """Type of a node, from offsets and types of its parts."""
    return np.dtype(
        {
            "names": list(fields),
            "formats": [kind for _, kind in fields.values()],
            "offsets": [offset for offset, _ in fields.values()],
            "itemsize": size,
        }
    )


GRID = _layout(
    736, magic=(0, "S8"), version=(16, "<u4"), name=(40, "S256"), matrix=(384, ("<f8", (3, 3))),
    origin=(528, ("<f8", 3)), kind=(632, "<u4"), type=(636, "<u4"), root=(672 + 24, "<i8"),
)  # fmt: skip
_TREE = 672
_ROOT = _layout(64, tiles=(24, "<u4"), background=(28, "<f4"))
_TILE = _layout(32, key=(0, "<u8"), child=(8, "<i8"), on=(16, "<u4"), value=(20, "<f4"))
_LEAF = _layout(2144, on=(16, ("u1", 64)), values=(96, ("<f4", 512)))
#: Leaves at a time, so that memory is bounded.
_SOME = 1 << 12


@dataclass(frozen=True)
class _Level:
    """Inner nodes: the logarithm of entries along an axis, cells of an entry, and the layout."""

    log: int
    cells: int
    layout: np.dtype[np.void]

    def places(self, entries: Integers) -> Integers:
        """Cells of entries from the corner of the node, shape (K, 3)."""
        mask = (1 << self.log) - 1
        found = [entries >> 2 * self.log, (entries >> self.log) & mask, entries & mask]
        return np.asarray(np.stack(found, axis=1) * self.cells)


def _inner(log: int, cells: int, table: int, size: int) -> _Level:
    count = 1 << 3 * log
    masks = (("u1", count // 8), 32, 32 + count // 8)
    layout = _layout(size, on=(masks[1], masks[0]), child=(masks[2], masks[0]),
                     table=(table, ("<i8", count)))  # fmt: skip
    return _Level(log, cells, layout)


_UPPER, _LOWER = _inner(5, 128, 8256, 270400), _inner(4, 8, 1088, 33856)


def name_of(data: Bytes, where: str) -> str:
    """Name of a raw grid."""
    return bytes(_record(data, 0, GRID, where)["name"]).decode("utf-8", "replace")


def dense(data: Bytes, where: str) -> FileGrid:
    """Makes a dense grid of a grid.

    Args:
        data: Bytes of the grid.
        where: Owner, for messages.

    Raises:
        InputError: The grid is of another version or kind, damaged, or too large.
    """
    grid = _record(data, 0, GRID, where)
    _check_kind(grid, where)
    root = _TREE + int(grid["root"])
    head = _record(data, root, _ROOT, where)
    tree = _Tree(data, root, int(head["tiles"]), where)
    low, high = tree.box()
    size = high - low + 2
    most = min(MAX_VALUES, most_unpacked(len(data)) // 4)
    if int(np.prod(size, dtype=object)) > most:
        raise InputError(
            f"{where}: wanted at most {most} cells around the active values of {len(data)} bytes, "
            f"got {' x '.join(map(str, size))}"
        )
    values = tree.filled(low - 1, high + 1, float(head["background"]))
    if not np.isfinite(values).all():
        raise InputError(f"{where}: numbers must be finite")
    return FileGrid(
        freeze_in_place(values[..., None]),
        freeze_in_place(_transform(grid, low - 1, size, where)),
        bytes(grid["name"]).decode("utf-8", "replace"),
    )


def _check_kind(grid: np.void, where: str) -> None:
    if bytes(grid["magic"]) not in _MAGIC:
        raise InputError(f"{where}: wanted a grid of NanoVDB, got {bytes(grid['magic'])!r}")
    if (version := int(grid["version"]) >> 21) != _VERSION:
        raise InputError(f"{where}: wanted a grid of NanoVDB {_VERSION}, got version {version}")
    if grid["type"] != _FLOAT:
        raise InputError(
            f"{where}: wanted a grid of single-precision numbers (type {_FLOAT}), "
            f"got type {grid['type']}"
        )
    if grid["kind"] == _LEVEL_SET:
        raise InputError(f"{where}: wanted a grid of densities, got a level set")


def _transform(grid: np.void, low: Integers, size: Integers, where: str) -> NDArray[np.float64]:
    """From the unit cube to the world; cell i is centred at i of the file."""
    cells, world = np.diag([*size, 1.0]), np.eye(4)
    cells[:3, 3] = low - 0.5
    world[:3, :3], world[:3, 3] = grid["matrix"], grid["origin"]
    with np.errstate(over="ignore", invalid="ignore"):
        found = np.asarray(world @ cells)
    if not np.isfinite(found).all():
        raise InputError(f"{where}: numbers of the transform must be finite")
    return found


def _record(data: Bytes, at: int, layout: np.dtype[np.void], where: str) -> np.void:
    """A record at a place."""
    found: np.void = _records(data, at, 1, layout, where)[0]
    return found


def _records(
    data: Bytes, at: int, count: int, layout: np.dtype[np.void], where: str
) -> NDArray[np.void]:
    if at < 0 or at + count * layout.itemsize > len(data):
        raise InputError(
            f"{where}: wanted {count * layout.itemsize} bytes at {at}, got {len(data)} in all"
        )
    return np.frombuffer(data, layout, count, at)


class _Tree:
    """Values of a tree: blocks of a constant value, and leaves.

    Args:
        data: Bytes of the grid.
        root: Where its root is.
        tiles: Number of tiles of the root.
        where: Owner, for messages.

    Raises:
        InputError: A node is outside of the grid, or nodes are used more than once.
    """

    def __init__(self, data: Bytes, root: int, tiles: int, where: str) -> None:
        self._data, self._where = data, where
        self._left: dict[int, int] = {}
        self._blocks: list[_Blocks] = []
        leaves = [np.zeros(0, np.int64)]
        corners = [np.zeros((0, 3), np.int64)]
        for at, corner in self._uppers(root, tiles):
            for below, begin in zip(*self._inside(_UPPER, at, corner), strict=True):
                found, begins = self._inside(_LOWER, int(below), begin)
                self._spend(_LEAF, len(found))
                leaves.append(found)
                corners.append(begins)
        self._leaves, self._corners = np.concatenate(leaves), np.concatenate(corners)
        last = len(data) - _LEAF.itemsize
        if len(self._leaves) and not (self._leaves.min() >= 0 and self._leaves.max() <= last):
            raise InputError(f"{where}: leaves are outside of the grid")

    def box(self) -> tuple[Integers, Integers]:
        """First active cell along each axis, and last plus 1; 0 and 0 if no cell is active."""
        found = [(block.corners.min(axis=0), block.corners.max(axis=0) + block.size)
                 for block in self._blocks]  # fmt: skip
        for rows, corners in self._some_leaves():
            on = np.unpackbits(rows["on"], axis=1, bitorder="little").reshape(-1, 8, 8, 8)
            if on.any():
                cells = [
                    (corners[:, axis, None] + np.arange(8))[on.any(axis=others) > 0]
                    for axis, others in enumerate(((2, 3), (1, 3), (1, 2)))
                ]
                found.append((np.array([corner.min() for corner in cells]),
                              np.array([corner.max() + 1 for corner in cells])))  # fmt: skip
        if not found:
            return np.zeros(3, np.int64), np.zeros(3, np.int64)
        low, high = zip(*found, strict=True)
        return np.asarray(np.min(low, axis=0)), np.asarray(np.max(high, axis=0))

    def filled(self, low: Integers, high: Integers, background: float) -> NDArray[np.float32]:
        """Values of the cells from ``low`` up to ``high``, shape (Z, Y, X)."""
        first, last = low // 8 * 8, -(-high // 8) * 8
        size = last - first
        check_room(8 * int(np.prod(size, dtype=object)), self._where)
        values = np.full(size[::-1], background, np.float32)
        for block in self._blocks:
            block.fill(values, first)
        leaves = values.reshape([n for count in size[::-1] // 8 for n in (count, 8)])
        for rows, corners in self._some_leaves():
            x, y, z = ((corners - first) // 8).T
            cells = rows["values"].reshape(-1, 8, 8, 8).transpose(0, 3, 2, 1)
            inside = ((corners >= first) & (corners < last)).all(axis=1)  # else inactive
            leaves[z[inside], :, y[inside], :, x[inside], :] = cells[inside]
        x, y, z = (slice(*pair) for pair in zip(low - first, high - first, strict=True))
        return np.ascontiguousarray(values[z, y, x])

    def _uppers(self, root: int, count: int) -> Iterator[tuple[int, Integers]]:
        """Upper nodes, each with its first cell; active tiles become blocks."""
        tiles = _records(self._data, root + _ROOT.itemsize, count, _TILE, self._where)
        for tile in tiles:
            key = int(tile["key"])
            # Parts of the key have 20 bits, with a sign.
            parts = [(key >> shift & 0xFFFFF) for shift in (42, 21, 0)]
            corner = np.array([(part ^ 0x80000) - 0x80000 for part in parts]) * 4096
            if tile["child"]:
                yield root + int(tile["child"]), corner
            elif tile["on"]:
                self._blocks.append(_Blocks(4096, corner[None], tile["value"][None]))

    def _inside(self, level: _Level, at: int, corner: Integers) -> tuple[Integers, Integers]:
        """Nodes below an inner node (K,), and their first cells (K, 3)."""
        self._spend(level.layout, 1)
        node = _record(self._data, at, level.layout, self._where)
        child, on = (np.unpackbits(node[key], bitorder="little") for key in ("child", "on"))
        table = node["table"]
        tiles = np.flatnonzero((on != 0) & (child == 0))
        if len(tiles):
            values = np.ascontiguousarray(table[tiles]).view("<f4")[::2]
            self._blocks.append(_Blocks(level.cells, corner + level.places(tiles), values))
        nodes = np.flatnonzero(child)
        # Places of nodes are checked where they are read; sums must not wrap around before.
        far = np.clip(table[nodes], -len(self._data) - 1, len(self._data))
        return at + far, corner + level.places(nodes)

    def _spend(self, layout: np.dtype[np.void], count: int) -> None:
        """Counts nodes of a kind: the grid has room for so many and no more."""
        size = layout.itemsize
        self._left[size] = self._left.get(size, len(self._data) // size) - count
        if self._left[size] < 0:
            raise InputError(f"{self._where}: a node appears twice")

    def _some_leaves(self) -> Iterator[tuple[NDArray[np.void], Integers]]:
        """Leaves and their first cells, some at a time."""
        places = max(len(self._data) - _LEAF.itemsize + 1, 0)
        all_of_them: NDArray[np.void] = np.ndarray((places,), _LEAF, self._data, strides=(1,))
        for begin in range(0, len(self._leaves), _SOME):
            part = slice(begin, begin + _SOME)
            yield all_of_them[self._leaves[part]], self._corners[part]


@dataclass(frozen=True, eq=False)
class _Blocks:
    """Cubes of cells with a constant value each.

    Attributes:
        size: Cells along a side.
        corners: First cells, shape (K, 3).
        values: Shape (K,).
    """

    size: int
    corners: Integers
    values: NDArray[np.float32]

    def fill(self, out: NDArray[np.float32], first: Integers) -> None:
        """Sets the cells of a grid (Z, Y, X) with ``first`` as the index of its first cell."""
        for corner, value in zip(self.corners - first, self.values, strict=True):
            x, y, z = (slice(int(begin), int(begin) + self.size) for begin in corner)
            out[z, y, x] = value
