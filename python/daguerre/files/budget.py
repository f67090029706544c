"""Limits on what a small file can ask for, all its wishes together."""

from __future__ import annotations

from .json_item import Item


class Budget:
    """Counts down.

    Args:
        limit: Largest number in all.
        what: Name of the things counted.
    """

    def __init__(self, limit: int, what: str) -> None:
        self._limit = limit
        self._left = limit
        self._what = what

    def spend(self, count: int, item: Item) -> None:
        """Takes ``count``; too many are a complaint about ``item``."""
        self._left -= count
        if self._left < 0:
            item.fail(f"wanted at most {self._limit} {self._what}, got more")
