"""Looks up glass names, as imported files spell them, in the makers' catalogues."""

from __future__ import annotations

from typing import Any

from daguerre.errors import suggest
from daguerre.lenses import glasses


def find(name: str, makers: tuple[str, ...] = ()) -> tuple[dict[str, Any], str] | None:
    """Finds the glass for a name, with a note if another was substituted; None: no such glass.

    Args:
        name: Name in a file's spelling; hyphens and spaces do not matter.
        makers: Names of catalogues to search first, such as ``SCHOTT`` or ``OHARA_2021-04``.
    """
    known = {maker.upper(): maker for maker in glasses.MAKERS}
    keys = dict.fromkeys(maker.upper().split("_")[0] for maker in makers)
    for maker in (*(known[key] for key in keys if key in known), None):
        found = glasses.lookup(name, maker)
        if found is None:
            continue
        glass = {"name": found.name}
        if found.maker in glasses.MAKERS:
            glass["maker"] = found.maker
        return glass, found.note
    return None


def nearest(name: str) -> str:
    """Suggestion of the nearest name, for the end of a message."""
    return suggest(name, glasses.names())
