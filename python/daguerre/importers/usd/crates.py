"""Checks binary layers ("crates") before USD opens them, as USD trusts the counts that they state.

A damaged count may ask USD for all memory of the machine, or end the process. Here each count is
checked against the bytes behind it: of the sections, and of all arrays.

Source: OpenUSD, ``pxr/usd/sdf/crateFile.h``, ``crateValueTypes.h`` (layout).
"""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

from .crate_blocks import DamageError, extremes, unpacked
from .crate_values import ARRAY, DICTIONARY, INLINED, OFFSET, VALUES, Nested
from .text_layers import too_deep, too_deep_error

#: First bytes of a binary layer.
MAGIC = b"PXR-USDC"
#: Bytes that a byte of LZ4 can stand for, and 32-bit numbers that a byte of packed numbers can.
_LZ4, _PACKED = 255, 4 * 255
#: Counts at the beginning of sections, and packed blocks after them.
_SECTIONS = {b"FIELDS": (1, 2), b"FIELDSETS": (1, 1), b"PATHS": (2, 3), b"SPECS": (1, 3)}
_COMPRESSED = 1 << 61
_INTEGERS, _FLOATS, _TIME_SAMPLES = (3, 4, 5, 6), (7, 8, 9), 46
_ASSET, _PATH_EXPRESSION = 12, 57
#: Smallest array that is packed.
_SMALLEST_PACKED = 16


def check_crate(data: memoryview, file: str) -> bool:
    """Checks a binary layer.

    Args:
        data: Bytes of the layer.
        file: File, for messages.

    Returns:
        Whether the layer names files in values.

    Raises:
        InputError: The layer states more than its bytes can hold, or nests values too deeply.
    """
    try:
        return _Crate(data, file).check()
    except InputError:  # a ValueError, too
        raise
    except (struct.error, IndexError, ValueError, DamageError) as error:
        reason = str(error) if isinstance(error, DamageError) else "it ends too early"
        raise InputError(f"{file}: damaged binary layer: {reason}") from None


class _Crate:
    def __init__(self, data: memoryview, file: str) -> None:
        self._data, self._file = data, file
        major, minor, patch = data[8:11]
        self._version = major, minor, patch

    def check(self) -> bool:
        sections = self._sections()
        packed = self._version >= (0, 4, 0)
        for name, (counts, blocks) in _SECTIONS.items():
            if name in sections:
                what, (begin, size) = name.decode().lower(), sections[name]
                self._section(what, begin, size, counts if packed else 1, blocks if packed else 0)
        if b"STRINGS" in sections:
            begin, size = sections[b"STRINGS"]
            self._fits("strings", self._numbers("Q", begin)[0], (size - 8) / 4)
        if b"TOKENS" in sections:
            self._tokens(*sections[b"TOKENS"])
        if b"FIELDS" not in sections:
            return False
        reps = self._reps(*sections[b"FIELDS"])
        kinds = self._values(reps, 0)
        if _PATH_EXPRESSION in kinds and b"TOKENS" in sections:
            words = self._words(sections[b"TOKENS"][0]).split(b"\0")
            if any(too_deep(word) for word in words):
                raise too_deep_error(self._file)
        return _ASSET in kinds

    def _numbers(self, kind: str, offset: int, count: int = 1) -> tuple[int, ...]:
        if not 0 <= offset <= len(self._data):
            raise DamageError(f"wanted an offset in the file, got {offset}")
        return struct.unpack_from(f"<{count}{kind}", self._data, offset)

    def _sections(self) -> dict[bytes, tuple[int, int]]:
        """Begin and size of each section."""
        (table,) = self._numbers("q", 16)
        (count,) = self._numbers("Q", table)
        self._fits("sections", count, (len(self._data) - table) / 32)
        found = {}
        for i in range(count):
            name, begin, size = struct.unpack_from("<16s2q", self._data, table + 8 + 32 * i)
            if begin < 0 or size < 0 or begin + size > len(self._data):
                raise DamageError(f"wanted sections in the file, got one at {begin} of {size}")
            found[name.rstrip(b"\0")] = begin, size
        return found

    def _fits(self, what: str, count: int, most: float) -> None:
        if count > most:
            raise DamageError(f"wanted at most {int(most)} {what}, got {count}")

    def _section(self, what: str, begin: int, size: int, counts: int, blocks: int) -> None:
        for count in self._numbers("Q", begin, counts):
            self._fits(what, count, size * _PACKED)
        at = begin + 8 * counts
        for _ in range(blocks):
            (length,) = self._numbers("Q", at)
            self._fits(f"bytes of packed {what}", length, begin + size - at - 8)
            at += 8 + length

    def _tokens(self, begin: int, size: int) -> None:
        count, length = self._numbers("Q", begin, 2)
        if self._version >= (0, 4, 0):
            self._fits("bytes of packed tokens", self._numbers("Q", begin + 16)[0], size - 24)
        self._fits("bytes of tokens", length, size * _LZ4)
        self._fits("tokens", count, length)

    def _reps(self, begin: int, size: int) -> NDArray[np.uint64]:
        """Values of all fields: each a type and an offset."""
        count, packed = self._numbers("Q", begin, 2)
        if self._version < (0, 4, 0):
            return np.frombuffer(self._data, "<u8", 2 * count, begin + 8)[1::2].copy()
        where = begin + 16 + packed
        (packed,) = self._numbers("Q", where)
        if where + 8 + packed > begin + size:
            raise DamageError("fields are outside of their section")
        return np.frombuffer(unpacked(self._data[where + 8 : where + 8 + packed], 8 * count), "<u8")

    def _values(self, reps: NDArray[np.uint64], depth: int) -> set[int]:
        """Checks values, also in dictionaries and time samples; returns their types."""
        kinds = (reps >> np.uint64(48)) & np.uint64(0xFF)
        found = {int(kind) for kind in np.unique(kinds)}
        nested = Nested(self._data)
        for kind in found & {DICTIONARY, *VALUES}:
            for rep in np.unique(reps[kinds == kind]).tolist():
                inner = nested.inside(rep)
                found |= self._values(np.array(inner, np.uint64), 1) if inner else set()
        for rep in reps[(reps & np.uint64(INLINED)) == 0].tolist():
            offset, kind = rep & OFFSET, rep >> 48 & 0xFF
            self._numbers("B", offset)
            if rep & ARRAY and offset:
                self._array(offset, kind, bool(rep & _COMPRESSED))
            elif kind == _TIME_SAMPLES and not depth:
                found |= self._values(self._samples(offset), 1)
        return found

    def _words(self, begin: int) -> bytes:
        """Names and texts of the layer, each with a zero byte at its end."""
        _, length, packed = self._numbers("Q", begin, 3)
        return unpacked(self._data[begin + 24 : begin + 24 + packed], length)

    def _array(self, offset: int, kind: int, packed: bool) -> None:
        if self._version < (0, 5, 0):
            offset += 4
        wide = self._version >= (0, 7, 0)
        (count,) = self._numbers("Q" if wide else "I", offset)
        offset += 8 if wide else 4
        most, entries = len(self._data) - offset, 0
        if packed and count >= _SMALLEST_PACKED:
            if kind in _FLOATS:
                code = bytes(self._data[offset : offset + 1])
                offset += 1
                if code == b"t":
                    (entries,) = self._numbers("I", offset)
                    offset += 4 + entries * {7: 2, 8: 4, 9: 8}[kind]
            if kind in (*_INTEGERS, *_FLOATS):
                (size,) = self._numbers("Q", offset)
                self._fits("bytes of an array", size, len(self._data) - offset)
                most = size * _PACKED
        self._fits("elements of an array", count, most)
        if entries:
            block = self._data[offset + 8 : offset + 8 + size]
            if not all(0 <= index < entries for index in extremes(block, count)):
                raise DamageError("values of an array are outside of its table")

    def _samples(self, offset: int) -> NDArray[np.uint64]:
        """Values of time samples, and their times."""
        (jump,) = self._numbers("q", offset)
        times = offset + jump
        (jump,) = self._numbers("q", times + 8)
        values = times + 8 + jump
        (count,) = self._numbers("Q", values)
        self._fits("time samples", count, (len(self._data) - values) / 8)
        found = np.frombuffer(self._data, "<u8", count, values + 8).copy()
        return np.append(found, np.array(self._numbers("Q", times), np.uint64))
