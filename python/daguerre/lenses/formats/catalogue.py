"""Looks up glass names, as imported files spell them, in the makers' catalogues."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from daguerre.errors import suggest
from daguerre.lenses import glasses
from daguerre.lenses.glasses import GlassData
from daguerre.lenses.glasses.catalogue import asked as catalogues_asked

#: Glasses of one name differ if nd or Vd differ by more.
SAME_ND, SAME_VD = 5e-5, 0.05


def known_maker(name: str) -> str | None:
    """Catalogue of a maker that files write as ``OHARA_2021-04`` or ``CDGM201904``; None: none."""
    letters = re.match(r"[A-Z]*", name.upper())
    return {maker.upper(): maker for maker in glasses.MAKERS}.get(letters[0] if letters else "")


def find(name: str, makers: tuple[str, ...] = ()) -> tuple[dict[str, Any], str] | None:
    """Finds the glass for a name, with a note on a substitution or on others of its name.

    Args:
        name: Name in a file's spelling; hyphens and spaces do not matter.
        makers: Names of catalogues to search first, such as ``SCHOTT`` or ``OHARA_2021-04``.

    Returns:
        The glass and the note, which may be empty; None: no such glass.
    """
    asked = dict.fromkeys(known for maker in makers if (known := known_maker(maker)))
    found = _first(name, tuple(asked)) or _first(name, (None,))
    if found is None:
        return None
    glass = {"name": found.name}
    if found.maker in glasses.MAKERS:
        glass["maker"] = found.maker
    return glass, found.note or _others(found, tuple(asked))


def _first(name: str, makers: Iterable[str | None]) -> GlassData | None:
    return next((g for maker in makers if (g := glasses.lookup(name, maker)) is not None), None)


def _others(found: GlassData, asked: tuple[str, ...]) -> str:
    """Note on other glasses of the same name, in the catalogues of the file if it names any."""
    makers = asked if found.maker in asked else glasses.MAKERS
    same = (glasses.lookup(found.name, maker) for maker in makers)
    differ = [g.maker for g in same if g is not None and not g.note and _differ(g, found)]
    if not differ:
        return ""
    return f"{found.name}: took that of {found.maker}, others differ ({', '.join(differ)})"


def _differ(a: GlassData, b: GlassData) -> bool:
    return abs(a.nd - b.nd) > SAME_ND or abs(a.vd - b.vd) > SAME_VD


def missing(name: str) -> str:
    """End of a message on a glass that no catalogue has: those asked, and the nearest names."""
    return f"{catalogues_asked()} have no {name!r}{suggest(name, glasses.names())}"
