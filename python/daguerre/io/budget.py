"""A limit on what a file may grow to: a few kB can ask for any number of bytes."""

from __future__ import annotations

from daguerre.errors import InputError

from .json_item import Item


class Budget:
    """Bytes that may still be unpacked.

    Args:
        what: What is unpacked, as a complaint calls it.
        limit: How many bytes in all.
    """

    def __init__(self, what: str, limit: int) -> None:
        self._what = what
        self._limit = limit
        self._left = limit

    def spend(self, size: int, item: Item) -> None:
        """Takes ``size`` bytes for ``item``.

        Raises:
            InputError: So many are not left.
        """
        self._left -= size  # the lock of the interpreter suffices: it need not be exact
        if self._left < 0:
            raise InputError(
                f"{item.file}: {self._what}: wanted at most {self._limit >> 30} GiB decoded, "
                f"got more at {item.path}"
            )
