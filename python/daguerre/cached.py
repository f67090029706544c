"""``cached_property`` without a lock: two threads that ask at once both find the value.

That of Python 3.11 holds one lock per class while it works: other threads wait for other objects of
the class, and a process that was forked meanwhile waits for ever. Python 3.12 dropped the lock.
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
        """A property that is worked out once, and kept in the object."""

        def __get__(self, instance: Any, owner: type[Any] | None = None) -> Any:
            if instance is None:
                return self
            kept = vars(instance)
            if self.attrname not in kept:
                kept[self.attrname] = self.func(instance)
            return kept[self.attrname]
