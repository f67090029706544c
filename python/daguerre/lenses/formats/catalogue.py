"""Names of glasses as foreign files spell them, in the makers' catalogues."""

from __future__ import annotations

from typing import Any

from daguerre.errors import suggest
from daguerre.lenses import glasses
from daguerre.lenses.errors import LensError


def find(name: str, makers: tuple[str, ...] = ()) -> tuple[dict[str, Any], str] | None:
    """The lens file's glass for a name, and what was taken instead of it; None: no such glass.

    Args:
        name: As a file spells it; hyphens and spaces do not matter.
        makers: Names of catalogues, such as ``SCHOTT`` or ``OHARA_2021-04``; they come first.
    """
    known = {maker.upper(): maker for maker in glasses.MAKERS}
    wanted = [known[key] for m in makers if (key := m.upper().split("_")[0]) in known]
    for maker in (*wanted, None):
        try:
            found = glasses.find(name, maker)
        except LensError:
            continue
        glass = {"name": found.name}
        if found.maker in glasses.MAKERS:
            glass["maker"] = found.maker
        return glass, found.note
    return None


def nearest(name: str) -> str:
    """A suggestion, for the end of a message."""
    return suggest(name, glasses.names())
