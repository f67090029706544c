"""Values over time: keys, spins, and how they are sampled."""

from __future__ import annotations

from .values import Keys, Spin, keys, spin

__all__ = ["Keys", "Spin", "keys", "spin"]
