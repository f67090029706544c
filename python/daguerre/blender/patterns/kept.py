"""Keeps patterns that were computed: the viewport and animations ask for the same ones again."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

Arrays = list[NDArray[np.float32]]
#: Bytes that are kept.
MOST = 1 << 28
#: Texels from which a pattern takes longer than the look for it.
_LEAST = 1 << 12


class Kept:
    """Cache of function results by arguments; drops the least recently used results.

    Args:
        most: Most bytes of all results.
    """

    def __init__(self, most: int = MOST) -> None:
        self._most = most
        self._found: OrderedDict[bytes, Arrays] = OrderedDict()
        self._lock = threading.Lock()

    def kept(self, function: Callable[..., Arrays], identity: str) -> Callable[..., Arrays]:
        """Makes a function that looks for its results before it computes them.

        Args:
            function: Takes numbers and arrays; its results depend on nothing else.
            identity: Text that no other function has.
        """

        def apply(*values: ArrayLike) -> Arrays:
            given = [np.asarray(value, np.float32) for value in values]
            if max((one.size for one in given), default=0) < _LEAST:
                return function(*given)
            key = _digest(identity, given)
            found = self._get(key)
            if found is None:
                found = function(*given)
                self._put(key, found)
            return [one.copy() for one in found]

        return apply

    def _get(self, key: bytes) -> Arrays | None:
        with self._lock:
            if key in self._found:
                self._found.move_to_end(key)
            return self._found.get(key)

    def _put(self, key: bytes, found: Arrays) -> None:
        with self._lock:
            self._found[key] = found
            while sum(_bytes(one) for one in self._found.values()) > self._most:
                self._found.popitem(last=False)


def _bytes(arrays: Arrays) -> int:
    return sum(one.nbytes for one in arrays)


def _digest(identity: str, given: Arrays) -> bytes:
    hashed = hashlib.blake2b(identity.encode(), digest_size=16)
    for one in given:
        hashed.update(repr(one.shape).encode())
        hashed.update(np.ascontiguousarray(one).data)
    return hashed.digest()


#: Patterns of this process.
PATTERNS = Kept()
