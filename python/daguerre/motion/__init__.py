"""Values over time: keys, spins, and how they are sampled."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.on_use import on_use

if TYPE_CHECKING:
    from .values import Keys, Spin, keys, spin

__all__ = ["Keys", "Spin", "keys", "spin"]

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = on_use(
        __name__,
        {
            "Keys": "values",
            "Spin": "values",
            "keys": "values",
            "spin": "values",
        },
    )
