"""Finds values inside of values of binary layers: dictionaries may hold dictionaries, to any depth.

Source: OpenUSD, ``pxr/usd/sdf/crateFile.cpp`` (``VtDictionary`` and ``VtValue``).
"""

from __future__ import annotations

import struct

from .crate_blocks import DamageError

ARRAY, INLINED = 1 << 63, 1 << 62
OFFSET = (1 << 48) - 1
#: Types of values: a dictionary, and types that hold a value of any type.
DICTIONARY, VALUES = 31, (52, 53)
#: Largest depth of values, and most values in a dictionary with nested dictionaries.
_DEEPEST, _MOST = 128, 10_000_000


class Nested:
    """Values inside of values.

    Args:
        data: Bytes of the layer.
    """

    def __init__(self, data: memoryview) -> None:
        self._data = data
        self._sizes: dict[int, int] = {}
        self._plain: set[int] = set()

    def inside(self, rep: int) -> list[int]:
        """Values nested in a value that are no dictionaries, each once in all calls.

        Raises:
            DamageError: The value is nested too deeply, contains itself, or has too many values.
        """
        self._size(rep, 0)
        found, self._plain = sorted(self._plain), set()
        return found

    def _size(self, rep: int, depth: int) -> int:
        """Number of values read for a value; shared parts count each time."""
        kind = rep >> 48 & 0xFF
        if rep & (ARRAY | INLINED) or kind not in (DICTIONARY, *VALUES):
            self._plain.add(rep)
            return 1
        if rep not in self._sizes:
            if depth > _DEEPEST:
                raise DamageError(f"wanted at most {_DEEPEST} values inside of one another")
            parts = self._parts(rep & OFFSET, kind)
            self._sizes[rep] = 1 + sum(self._size(part, depth + 1) for part in parts)
            if self._sizes[rep] > _MOST:
                raise DamageError(f"wanted at most {_MOST} values in a dictionary")
        return self._sizes[rep]

    def _parts(self, offset: int, kind: int) -> list[int]:
        """Values directly inside of a value."""
        count, at, name = 1, offset, 0
        if kind == DICTIONARY:
            (count,) = struct.unpack_from("<Q", self._data, offset)
            at, name = offset + 8, 4
        if count > (len(self._data) - at) / (8 + name):
            raise DamageError(f"wanted values in the file, got a dictionary of {count}")
        found = []
        for _ in range(count):  # a name, the way to the value, and the next one after that
            at += name + struct.unpack_from("<q", self._data, at + name)[0]
            if not 0 <= at <= len(self._data) - 8:
                raise DamageError(f"wanted an offset in the file, got {at}")
            found.append(struct.unpack_from("<Q", self._data, at)[0])
            at += 8
        return found
