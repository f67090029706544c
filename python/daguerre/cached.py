"""``cached_property`` without a lock: two threads that read it at once both compute the value.

Python 3.11's version holds a lock of the class while it computes: threads wait for other objects of
the class, and a process forked meanwhile waits for ever. Python 3.12 removed the lock.
"""

from __future__ import annotations

import functools
import sys
from typing import TYPE_CHECKING, Any

__all__ = ["cached_property"]

if TYPE_CHECKING or sys.version_info >= (3, 12):
    from functools import cached_property
else:

    class cached_property(functools.cached_property):
        """Property that is computed at the first read and kept in the object."""

        def __get__(self, instance: object, owner: type[Any] | None = None) -> Any:
            if instance is None:
                return self
            kept = vars(instance)
            if self.attrname not in kept:
                kept[self.attrname] = self.func(instance)
            return kept[self.attrname]
