"""Members of a lens file that may be absent or null."""

from __future__ import annotations

from daguerre.files.json_item import Item, clean

from .surface import Triple


def member(item: Item, key: str) -> Item | None:
    """The member of that name, or None where it is absent or null."""
    found = item.get(key)
    return None if found is None or found.value is None else found


def number(item: Item, key: str, *, above: float | None = None) -> float | None:
    """A finite number, or None."""
    found = member(item, key)
    return None if found is None else found.number(above=above)


def text(item: Item, key: str) -> str | None:
    """Text that can be printed, or None."""
    found = member(item, key)
    return None if found is None else clean(found.text())


def triple(item: Item, key: str, limit: float) -> Triple:
    """Three numbers of at most ``limit``; zeros if absent."""
    found = member(item, key)
    if found is None:
        return (0.0, 0.0, 0.0)
    x, y, z = found.numbers(3, -limit, limit)
    return (x, y, z)
