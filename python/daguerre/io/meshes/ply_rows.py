"""Rows of an element of a PLY file as columns.

Rows without lists are an array of records. Rows with lists have sizes of their own: a run of rows
whose lists are equally long is an array of records, too, and most files have few runs. Where runs
are short, lengths of lists are followed from row to row, and rows of equal lengths are gathered.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

from .file_bytes import Bytes
from .ply_header import Element, Property

Records = NDArray[np.void]
Integers = NDArray[np.int64]
Floats = NDArray[np.float32]
#: Records, and the rows that they are; None: all of a block.
Part = tuple[Records, Integers | None]
#: Numbers that were found one by one, or all at once.
Found = list[int] | NDArray[Any]
#: Runs shorter than this are not worth an array; as many rows are then followed.
_SHORT_RUN, _FOLLOWED = 64, 1 << 16
#: Maximum size of a row, bytes.
_MOST_ROW = 1 << 30
#: Codes of ``struct`` for types of lengths.
_CODES = {
    "i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "i8": "q", "u8": "Q",
    "f8": "d",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Lists:
    """Lists of all rows.

    Attributes:
        sizes: Length of each list, shape (F,).
        values: Their numbers, one list after the other, shape (C,).
    """

    sizes: NDArray[np.int64]
    values: NDArray[Any]


class Rows:
    """Rows of an element in a file.

    Args:
        element: Its row of the header.
        data: Bytes of the file.
        begin: Where the rows begin.
        order: Byte order, "<" or ">".
        where: Owner, for messages.

    Attributes:
        end: Where they end.

    Raises:
        InputError: The file is too short for them, or a list has a negative length.
    """

    def __init__(self, element: Element, data: Bytes, begin: int, order: str, where: str) -> None:
        self._element, self._data, self._order, self._where = element, data, order, where
        self._lists = [one for one in element.properties if one.counted]
        self._follower = _Follower(element.properties, order, where)
        self._blocks: list[_Block] = []
        self.end = begin
        self._check_size()
        left = element.count
        while left:
            left -= self._run(left)

    def numbers(self, names: Sequence[str]) -> Floats:
        """Columns of numbers in single precision, shape (F, K)."""
        out = np.zeros((self._element.count, len(names)), np.float32)
        begin = 0
        for block in self._blocks:
            own = out[begin : begin + block.count]
            for records, rows in block.parts:
                _copy(records, [self._key(name) for name in names], own, rows)
            begin += block.count
        return out

    def lists(self, name: str) -> Lists:
        """A column of lists."""
        number = next(i for i, one in enumerate(self._lists) if one.name == name)
        sizes = _joined([block.sizes(number) for block in self._blocks])
        if not self._blocks:
            return Lists(sizes, sizes)
        key, end = self._key(name), 0
        values = np.empty(int(sizes.sum()), self._blocks[0].kind(key))
        for block in self._blocks:
            begin, end = end, end + int(block.sizes(number).sum())
            block.copy_lists(number, key, values[begin:end])
        return Lists(sizes, values)

    def _key(self, name: str) -> str:
        """Field of a property: names in the file may be empty or odd for NumPy."""
        return f"f{next(i for i, one in enumerate(self._element.properties) if one.name == name)}"

    def _check_size(self) -> None:
        """Checks the number of rows against the bytes that are left, before memory is taken."""
        least = self._record([0] * len(self._lists)).itemsize
        if self._element.count * least > len(self._data) - self.end:
            self._too_short()

    def _record(self, sizes: Sequence[int] | Integers) -> np.dtype[np.void]:
        """Type of rows whose lists have these lengths."""
        fields: list[Any] = []
        lengths = iter(map(int, sizes))
        for i, one in enumerate(self._element.properties):
            if one.counted:
                fields.append((f"n{i}", self._order + one.counted))
                fields.append((f"f{i}", self._order + one.type, (next(lengths),)))
            else:
                fields.append((f"f{i}", self._order + one.type))
        return np.dtype(fields)

    def _run(self, left: int) -> int:
        """Reads some rows; returns how many."""
        _, sizes, _ = self._followed(1)
        record = self._record(sizes[0])
        if record.itemsize == 0:
            return left
        most = min(left, (len(self._data) - self.end) // record.itemsize)
        records = np.frombuffer(self._data, record, most, self.end)
        count = self._equal(records, sizes[0])
        if count < min(_SHORT_RUN, left):
            return self._follow(min(left, _FOLLOWED))
        self._blocks.append(_Block(count, [(records[:count], None)], sizes))
        self.end += count * record.itemsize
        return count

    def _equal(self, records: Records, sizes: Integers) -> int:
        """How many records have lists of these lengths, from the first on."""
        fields = [f"n{i}" for i, one in enumerate(self._element.properties) if one.counted]
        begin, step = 0, _SHORT_RUN
        while begin < len(records) and fields:
            some = records[begin : begin + step]
            same = np.ones(len(some), bool)
            for field, size in zip(fields, sizes, strict=True):
                same &= some[field] == size
            if not same.all():
                return begin + int(np.argmin(same))
            begin, step = begin + step, 2 * step
        return len(records)

    def _follow(self, count: int) -> int:
        """Reads rows whose lists have many lengths."""
        begins, sizes, self.end = self._followed(count)
        parts: list[Part] = []
        for kind in _different(sizes):
            rows = np.flatnonzero((sizes == kind).all(axis=1))
            record = self._record(kind)
            at_each_byte = len(self._data) - record.itemsize + 1, record, self._data, 0, (1,)
            parts.append((np.ndarray(*at_each_byte)[begins[rows]], rows))
        self._blocks.append(_Block(count, parts, sizes))
        return count

    def _followed(self, count: int) -> tuple[Integers, Integers, int]:
        """Where the next rows begin (R,), lengths of their lists (R, L), and where they end."""
        try:
            begins, sizes, end = self._follower.follow(self._data, self.end, count)
        except (struct.error, IndexError):
            self._too_short()
        if end > len(self._data):
            self._too_short()
        if end - int(begins[-1]) > _MOST_ROW:
            raise InputError(f"{self._where}: wanted rows of at most {_MOST_ROW} bytes, got more")
        return begins, sizes, end

    def _too_short(self) -> NoReturn:
        raise InputError(
            f"{self._where}: wanted {self._element.count} rows, got the end of the file before"
        )


class _Follower:
    """Finds rows by the lengths of their lists."""

    def __init__(self, properties: Sequence[Property], order: str, where: str) -> None:
        self._where = where
        self._lists: list[tuple[int, struct.Struct, int]] = []  # bytes before, length, item
        self._tail = 0
        for one in properties:
            size = np.dtype(one.type).itemsize
            if one.counted:
                length = struct.Struct(order + _CODES[one.counted])
                self._lists.append((self._tail, length, size))
                self._tail = 0
            else:
                self._tail += size

    def follow(self, data: Bytes, at: int, count: int) -> tuple[Integers, Integers, int]:
        """Where rows begin (R,), lengths of their lists (R, L), and where the last one ends.

        Raises:
            InputError: A length is no whole number of at least 0.
            struct.error, IndexError: The data end before.
        """
        view = data.data
        plain = len(self._lists) == 1 and self._lists[0][1].format in ("<B", ">B")
        begins, sizes, end = (self._bytes if plain else self._any)(view, at, count)
        shape = (count, len(self._lists))
        return np.array(begins, np.int64), np.array(sizes, np.int64).reshape(shape), end

    def _bytes(self, view: memoryview, at: int, count: int) -> tuple[Found, Found, int]:
        """Follows rows of one list whose length is a byte."""
        before, _, item = self._lists[0]
        steps = [before + 1 + self._tail + size * item for size in range(256)]
        begins = [0] * count
        at += before
        for i in range(count):
            begins[i] = at
            at += steps[view[at]]
        lengths = np.array(begins)
        return lengths - before, np.frombuffer(view, np.uint8)[lengths], at - before

    def _any(self, view: memoryview, at: int, count: int) -> tuple[Found, Found, int]:
        begins, sizes = [], []
        for _ in range(count):
            begins.append(at)
            for before, length, item in self._lists:
                at += before
                (size,) = length.unpack_from(view, at)
                if not (size >= 0 and size % 1 == 0):
                    raise InputError(
                        f"{self._where}: wanted a whole number as the length of a list, got {size}"
                    )
                sizes.append(int(size))
                at += length.size + int(size) * item
                if at > len(view):
                    raise IndexError
            at += self._tail
        return begins, sizes, at


def _different(sizes: Integers) -> Integers:
    """Different rows of lengths (R, L), shape (K, L)."""
    if sizes.shape[1] != 1:
        return np.unique(sizes, axis=0)
    column = sizes[:, 0]
    if column.max() < len(column):  # few numbers are counted faster than sorted
        return np.asarray(np.flatnonzero(np.bincount(column))[:, None])
    return np.asarray(np.unique(column)[:, None])


class _Block:
    """Rows in parts whose lists are equally long."""

    def __init__(self, count: int, parts: list[Part], sizes: Integers) -> None:
        self.count, self.parts = count, parts
        self._sizes = np.broadcast_to(sizes, (count, sizes.shape[1]))

    def sizes(self, number: int) -> Integers:
        """Lengths of a column of lists, shape (F,)."""
        return self._sizes[:, number]

    def kind(self, key: str) -> np.dtype[Any]:
        """Type of the numbers of a column of lists, in the byte order of the machine."""
        return self.parts[0][0].dtype[key].base.newbyteorder("=")

    def copy_lists(self, number: int, key: str, out: NDArray[Any]) -> None:
        """Copies a column of lists, one list after the other, shape (C,)."""
        if len(self.parts) == 1:
            values = self.parts[0][0][key]
            out.reshape(values.shape)[...] = values
            return
        sizes = self.sizes(number)
        begins = np.cumsum(sizes) - sizes
        for records, rows in self.parts:
            values = records[key]
            out[begins[rows][:, None] + np.arange(values.shape[1])] = values


def _copy(records: Records, keys: list[str], out: Floats, rows: Integers | None) -> None:
    """Copies fields of records to the columns of rows; None: all rows."""
    fields: Any = records.dtype.fields
    kinds, begins = [fields[key][0] for key in keys], [fields[key][1] for key in keys]
    to: Any = slice(None) if rows is None else rows
    with np.errstate(over="ignore", invalid="ignore"):
        if begins == [begins[0] + i * kinds[0].itemsize for i in range(len(keys))] and all(
            kind == kinds[0] for kind in kinds
        ):  # one pass over memory
            packed = np.dtype(
                {
                    "names": ["all"],
                    "formats": [(kinds[0], (len(keys),))],
                    "offsets": [begins[0]],
                    "itemsize": records.dtype.itemsize,
                }
            )
            out[to] = records.view(packed)["all"]
            return
        for column, key in enumerate(keys):
            out[to, column] = records[key]


def _joined(parts: list[NDArray[Any]]) -> NDArray[Any]:
    """Arrays one after the other; a single one is not copied."""
    if not parts:
        return np.zeros(0, np.int64)
    return parts[0] if len(parts) == 1 else np.concatenate(parts)
