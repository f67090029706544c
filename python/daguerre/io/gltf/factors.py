"""Factors of glTF materials: numbers and colours with the slack that exporters need."""

from __future__ import annotations

from daguerre.files.json_item import Item
from daguerre.scene.materials import Color

#: Exporters round: a factor may stand this far beyond 1.
SLACK = 1e-3


def fraction(item: Item | None, key: str, default: float) -> float:
    """A factor in 0 .. 1."""
    return default if item is None else min(item.number_of(key, default, 0, 1 + SLACK), 1.0)


def color_of(item: Item | None, key: str, default: float, high: float) -> Color:
    """A colour with every channel in 0 .. ``high``; grey by default."""
    if item is None:
        return (default, default, default)
    r, g, b = item.numbers_of(key, (default,) * 3, 0, high)
    return (r, g, b)


def unit_color(item: Item | None, key: str, default: float) -> Color:
    """A colour with every channel in 0 .. 1."""
    r, g, b = color_of(item, key, default, 1 + SLACK)
    return (min(r, 1.0), min(g, 1.0), min(b, 1.0))
