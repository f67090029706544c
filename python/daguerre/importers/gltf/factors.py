"""Reads factors of glTF materials: numbers and colours, with a tolerance for rounding."""

from __future__ import annotations

from daguerre.files.json_item import Item
from daguerre.scene.materials import Color

#: Tolerance above 1, as exporters round factors.
SLACK = 1e-3


def fraction(item: Item | None, key: str, default: float) -> float:
    """Reads a factor in 0 .. 1."""
    return default if item is None else min(item.number_of(key, default, 0, 1 + SLACK), 1.0)


def color_of(item: Item | None, key: str, default: float, high: float) -> Color:
    """Reads a colour with every channel in 0 .. ``high``; the default is grey."""
    if item is None:
        return (default, default, default)
    r, g, b = item.numbers_of(key, (default,) * 3, 0, high)
    return (r, g, b)


def unit_color(item: Item | None, key: str, default: float) -> Color:
    """Reads a colour with every channel in 0 .. 1."""
    r, g, b = color_of(item, key, default, 1 + SLACK)
    return (min(r, 1.0), min(g, 1.0), min(b, 1.0))
