"""Values over time: keys, spins, and how they are sampled."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.lazy_imports import lazy_attributes

if TYPE_CHECKING:
    from .values import Keys, Spin, keys, spin

__all__ = ["Keys", "Spin", "keys", "spin"]

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = lazy_attributes(
        __name__,
        {
            "Keys": "values",
            "Spin": "values",
            "keys": "values",
            "spin": "values",
        },
    )
