"""Rows of an element of a PLY file as columns.

Rows without lists are an array of records. Rows with lists differ in size: the core
follows them by the lengths of their lists.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre import _core
from daguerre.errors import CoreError, InputError
from daguerre.importers.file_bytes import Bytes

from .ply_header import Element

Records = NDArray[np.void]
Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Lists:
    """Lists of all rows.

    Attributes:
        sizes: Length of each list, shape (F,).
        values: Numbers of the lists, list after list, shape (C,).
    """

    sizes: NDArray[np.uint32]
    values: NDArray[Any]


class Rows:
    """Rows of an element in a file.

    Args:
        element: Element of the header.
        data: Bytes of the file.
        begin: Where the rows begin.
        order: Byte order, "<" or ">".
        where: Owner, for messages.

    Attributes:
        end: Where they end.

    Raises:
        InputError: The file is too short for them, or the length of a list is no length.
    """

    def __init__(self, element: Element, data: Bytes, begin: int, order: str, where: str) -> None:
        self._element, self._data, self._begin, self._order = element, data, begin, order
        self._fields = [
            (p.counted and order + p.counted, np.dtype(p.type).itemsize) for p in element.properties
        ]
        self._lists = [p.name for p in element.properties if p.counted]
        try:
            rows = self._followed() if self._lists else self._equal()
        except CoreError as error:
            raise InputError(f"{where}: {error}") from None
        if rows < element.count:
            raise InputError(f"{where}: truncated: wanted {element.count} rows")

    def numbers(self, names: Sequence[str]) -> Floats:
        """Columns of numbers in single precision, shape (F, K)."""
        return np.asarray(self._columns(names, np.float32))

    def positions(self, names: Sequence[str]) -> NDArray[np.floating]:
        """Columns of numbers, shape (F, K), in double precision if the file has one of them so."""
        double = any(self._element.properties[self._number(name)].type == "f8" for name in names)
        return self._columns(names, np.float64 if double else np.float32)

    def _columns(self, names: Sequence[str], kind: type[np.floating]) -> NDArray[np.floating]:
        out = np.empty((self._element.count, len(names)), kind)
        if self._lists:
            with np.errstate(over="ignore", invalid="ignore"):
                for column, name in enumerate(names):
                    out[:, column] = self._column(self._number(name), len(out))
        else:
            _copy(self._records, [f"f{self._number(name)}" for name in names], out)
        return out

    def lists(self, name: str) -> Lists:
        """A column of lists."""
        sizes = np.ascontiguousarray(self._lengths[:, self._lists.index(name)])
        return Lists(sizes, self._column(self._number(name), int(sizes.sum())))

    def _number(self, name: str) -> int:
        """Place of a property in its row."""
        return next(i for i, p in enumerate(self._element.properties) if p.name == name)

    def _equal(self) -> int:
        """Reads rows without lists; returns how many there are."""
        types = [self._order + p.type for p in self._element.properties]
        record = np.dtype([(f"f{i}", kind) for i, kind in enumerate(types)])
        rows = self._element.count
        if record.itemsize:
            rows = min(rows, (len(self._data) - self._begin) // record.itemsize)
            self._records = np.frombuffer(self._data, record, rows, self._begin)
        self.end = self._begin + rows * record.itemsize
        return rows

    def _followed(self) -> int:
        """Reads rows with lists; returns how many there are, or a part of them."""
        self._lengths, self.end = _core.list_lengths(
            self._data, self._begin, self._element.count, self._fields
        )
        return len(self._lengths)

    def _column(self, number: int, count: int) -> NDArray[Any]:
        """All ``count`` numbers of a property, or of its lists, of rows with lists."""
        out = np.empty(count, self._order + self._element.properties[number].type)
        _core.copy_field(
            self._data, self._begin, self._fields, self._lengths, number, out.view(np.uint8)
        )
        return out if out.dtype.isnative else out.astype(out.dtype.newbyteorder("="))


def _copy(records: Records, keys: list[str], out: Floats) -> None:
    """Copies fields of records to columns."""
    fields: Any = records.dtype.fields
    kinds, begins = [fields[key][0] for key in keys], [fields[key][1] for key in keys]
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
            out[...] = records.view(packed)["all"]
            return
        for column, key in enumerate(keys):
            out[:, column] = records[key]
