"""Checks binary layers ("crates") before USD opens them, as USD trusts the counts that they state.

A damaged count may ask USD for all memory of the machine, or end the process. Here each count is
held against the bytes behind it: those of the sections, and those of all arrays.

Source: OpenUSD, ``pxr/usd/sdf/crateFile.h``, ``crateValueTypes.h`` (layout).
"""

from __future__ import annotations

import mmap
import struct
import zipfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.files.reading import opened

_MAGIC = b"PXR-USDC"
#: Bytes that a byte of LZ4 can stand for, and 32-bit numbers that a byte of packed ones can.
_LZ4, _PACKED = 255, 4 * 255
#: Counts at the beginning of sections, and packed blocks after them.
_SECTIONS = {b"FIELDS": (1, 2), b"FIELDSETS": (1, 1), b"PATHS": (2, 3), b"SPECS": (1, 3)}
_ARRAY, _INLINED, _COMPRESSED = (1 << bit for bit in (63, 62, 61))
_OFFSET = (1 << 48) - 1
_INTEGERS, _FLOATS, _TIME_SAMPLES = (3, 4, 5, 6), (7, 8, 9), 46
#: Smallest array that is packed.
_SMALLEST_PACKED = 16


def check_crates(path: Path, file: str) -> None:
    """Checks a layer, or all layers of a package, if they are binary ones.

    Args:
        path: File of the layer or package.
        file: File, for messages.

    Raises:
        InputError: A crate states more than its bytes can hold.
    """
    if path.stat().st_size == 0:
        return
    with opened(path) as stream:
        whole = mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
    for begin, size in _crates(path, whole):
        try:
            _Crate(memoryview(whole)[begin : begin + size]).check()
        except (struct.error, IndexError, ValueError, _DamageError) as error:
            told = str(error) if isinstance(error, _DamageError) else "it ends too early"
            raise InputError(f"{file}: damaged binary layer: {told}") from None


def _crates(path: Path, whole: mmap.mmap) -> list[tuple[int, int]]:
    """Begin and size of each crate in a file."""
    if whole[:8] == _MAGIC:
        return [(0, len(whole))]
    if whole[:2] != b"PK":
        return []
    try:
        with zipfile.ZipFile(path) as package:
            entries = package.infolist()
    except (zipfile.BadZipFile, ValueError, OverflowError, NotImplementedError):
        return []  # USD tells what is wrong
    found = []
    for entry in entries:
        head = whole[entry.header_offset : entry.header_offset + 30]
        if len(head) == 30:
            begin = entry.header_offset + 30 + sum(struct.unpack_from("<2H", head, 26))
            if whole[begin : begin + 8] == _MAGIC:
                found.append((begin, min(entry.file_size, len(whole) - begin)))
    return found


class _DamageError(Exception):
    """Tells what is wrong with a crate."""


class _Crate:
    def __init__(self, data: memoryview) -> None:
        self._data = data
        major, minor, patch = data[8:11]
        self._version = major, minor, patch

    def check(self) -> None:
        sections = self._sections()
        packed = self._version >= (0, 4, 0)
        for name, (counts, blocks) in _SECTIONS.items():
            if name in sections:
                what = name.decode().lower()
                self._section(what, *sections[name], *((counts, blocks) if packed else (1, 0)))
        if b"STRINGS" in sections:
            begin, size = sections[b"STRINGS"]
            self._fits("strings", self._numbers("Q", begin)[0], (size - 8) / 4)
        if b"TOKENS" in sections:
            self._tokens(*sections[b"TOKENS"])
        if b"FIELDS" in sections:
            self._values(self._reps(*sections[b"FIELDS"]), 0)

    def _numbers(self, kind: str, offset: int, count: int = 1) -> tuple[int, ...]:
        if not 0 <= offset <= len(self._data):
            raise _DamageError(f"wanted an offset in the file, got {offset}")
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
                raise _DamageError(f"wanted sections in the file, got one at {begin} of {size}")
            found[name.rstrip(b"\0")] = begin, size
        return found

    def _fits(self, what: str, count: int, most: float) -> None:
        if count > most:
            raise _DamageError(f"wanted at most {int(most)} {what}, got {count}")

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
            raise _DamageError("fields are outside of their section")
        return np.frombuffer(
            _unpacked(self._data[where + 8 : where + 8 + packed], 8 * count), "<u8"
        )

    def _values(self, reps: NDArray[np.uint64], depth: int) -> None:
        """Checks arrays and time samples among some values; others are as short as they are."""
        stored = reps[(reps & np.uint64(_INLINED)) == 0].tolist()
        for rep in stored:
            offset, kind = rep & _OFFSET, rep >> 48 & 0xFF
            self._numbers("B", offset)
            if rep & _ARRAY and offset:
                self._array(offset, kind, bool(rep & _COMPRESSED))
            elif kind == _TIME_SAMPLES and not depth:
                self._values(self._samples(offset), 1)

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
            if not all(0 <= index < entries for index in _extremes(block, count)):
                raise _DamageError("values of an array are outside of its table")

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


def _extremes(data: memoryview, count: int) -> tuple[int, int]:
    """Smallest and largest of some packed 32-bit numbers: each is a step from the one before.

    A step is the usual one, or has 1, 2 or 4 bytes, which codes of two bits tell.
    """
    codes_end = 4 + (2 * count + 7) // 8
    raw = np.frombuffer(_unpacked(data, codes_end + 4 * count), np.uint8)
    bits = raw[4:codes_end, None] >> np.arange(0, 8, 2, dtype=np.uint8) & 3
    codes = bits.reshape(-1)[:count]
    widths = np.array([0, 1, 2, 4])[codes]
    starts = codes_end + np.cumsum(widths) - widths
    if len(codes) < count or codes_end + int(widths.sum()) > len(raw):
        raise _DamageError("too few packed numbers")
    steps = np.full(count, int(raw[:4].view("<i4")[0]), np.int64)
    for code, kind in ((1, "<i1"), (2, "<i2"), (3, "<i4")):
        chosen = starts[codes == code]
        size = np.dtype(kind).itemsize
        steps[codes == code] = raw[chosen[:, None] + np.arange(size)].copy().view(kind).reshape(-1)
    values = np.cumsum(steps).astype(np.int32)
    return int(values.min()), int(values.max())


def _unpacked(data: memoryview, size: int) -> bytes:
    """Unpacks ``size`` bytes, stored as one block of LZ4 or several."""
    if not len(data):
        return b""
    blocks, at = data[0], 1
    if not blocks:
        return _lz4(data[1:], size)
    made = bytearray()
    for _ in range(blocks):
        (length,) = struct.unpack_from("<i", data, at)
        if length <= 0:
            raise _DamageError("a block has 0 bytes")
        made += _lz4(data[at + 4 : at + 4 + length], size - len(made))
        at += 4 + length
    return bytes(made)


def _lz4(data: memoryview, most: int) -> bytes:
    """Unpacks a block of LZ4 of at most some bytes.

    Source: "LZ4 Block Format Description", lz4.org.
    """
    made, at = bytearray(), 0
    while at < len(data):
        token = data[at]
        length, at = _length(data, at + 1, token >> 4)
        made += data[at : at + length]
        at += length
        if at < len(data):
            (back,) = struct.unpack_from("<H", data, at)
            length, at = _length(data, at + 2, token & 15)
            length += 4
            if not 0 < back <= len(made) or len(made) + length > most:
                raise _DamageError("packed bytes are damaged")
            piece = made[-back:] if back >= length else made[-back:] * (length // back + 1)
            made += piece[:length]
    if len(made) > most:
        raise _DamageError(f"more than {most} unpacked bytes")
    return bytes(made)


def _length(data: memoryview, at: int, nibble: int) -> tuple[int, int]:
    """Length that begins in four bits and may go on in bytes; and where it ends."""
    if nibble == 15:
        more = 255
        while more == 255:
            more = data[at]
            nibble, at = nibble + more, at + 1
    return nibble, at
