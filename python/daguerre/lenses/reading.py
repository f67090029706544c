"""Reads members of a lens file that may be absent or null."""

from __future__ import annotations

from daguerre.files.json_item import Item, clean

from .surface import Triple


def member(item: Item, key: str) -> Item | None:
    """Member of that name; None: absent or null."""
    found = item.get(key)
    return None if found is None or found.value is None else found


def number(item: Item, key: str, *, above: float | None = None) -> float | None:
    """Reads a finite number; None: absent or null."""
    found = member(item, key)
    return None if found is None else found.number(above=above)


def text(item: Item, key: str) -> str | None:
    """Reads printable text; None: absent or null."""
    found = member(item, key)
    return None if found is None else clean(found.text())


def flag(item: Item, key: str) -> bool:
    """Reads true or false; false if absent or null."""
    found = member(item, key)
    return found is not None and found.flag()


def triple(item: Item, key: str, limit: float) -> Triple:
    """Reads three numbers of at most ``limit`` in magnitude; zeros if absent."""
    found = member(item, key)
    if found is None:
        return (0.0, 0.0, 0.0)
    x, y, z = found.numbers(3, -limit, limit)
    return (x, y, z)
