"""Budgets: limits on the total that a small file can request."""

from __future__ import annotations

from .json_item import Item


class Budget:
    """Counter with a limit.

    Args:
        limit: Maximum total.
        what: Unit of the count, for messages.
    """

    def __init__(self, limit: int, what: str) -> None:
        self._limit = limit
        self._left = limit
        self._what = what

    def spend(self, count: int, item: Item) -> None:
        """Adds ``count``; raises an error at ``item`` if the total exceeds the limit."""
        self._left -= count
        if self._left < 0:
            item.fail(f"too many {self._what}: the limit is {self._limit}")
