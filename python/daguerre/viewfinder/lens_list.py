"""Lenses to choose from, ideal and from the library: facts, photographs and search."""

from __future__ import annotations

import base64
from functools import cache
from pathlib import Path
from typing import Any

from daguerre.camera.ideal import IDEAL
from daguerre.lenses.index import PHOTOGRAPHS, entries
from daguerre.lenses.kinds import kinds_of
from daguerre.lenses.search import Subject, library, nearest, ranked
from daguerre.lenses.words import words_of

#: Kind of the lenses without glass.
IDEAL_KIND = "ideal"


def offered() -> list[dict[str, str]]:
    """Names and titles of all lenses, ideal ones first."""
    ideal = [{"name": name, "title": name} for name in IDEAL]
    return ideal + [{"name": one.name, "title": one.title} for one in entries()]


@cache
def facts() -> list[dict[str, Any]]:
    """Facts of all lenses by which a page shows and filters them, ideal lenses first.

    ``focal_mm`` and ``f_number`` are the values in a lens's name, by which people look for it;
    ``shown`` has computed values.
    """
    ideal = [{"name": name, "kinds": [IDEAL_KIND], "makers": []} for name in IDEAL]
    makers = _makers()
    return ideal + [
        {
            "name": entry.name,
            "year": entry.year,
            "focal_mm": subject.focal_mm[-1],
            "f_number": subject.f_numbers[-1],
            "shown": f"{entry.focal_length} · f/{entry.f_number:g}",
            "kinds": [kind.words[0] for kind in kinds_of(entry)],
            "makers": [name for name, words in makers.items() if words <= subject.words.keys()],
            "photograph": photograph_path(entry.name).exists(),
        }
        for entry, subject in zip(entries(), library(), strict=True)
    ]


def _makers() -> dict[str, set[str]]:
    """Makers and their words; Carl Zeiss Jena is listed as Zeiss, the name within its name."""
    known = {one.maker: {word.text for word in words_of(one.maker)} for one in entries()}
    words = {name: own for name, own in sorted(known.items()) if own}
    return {
        name: own for name, own in words.items() if not any(other < own for other in words.values())
    }


def photograph_path(name: str) -> Path:
    """File of the photograph of a lens of the library."""
    return PHOTOGRAPHS / f"{name}.webp"


def photograph(name: str) -> dict[str, str | None]:
    """Photograph of a lens of the library as text, for pages that cannot fetch a file."""
    path = photograph_path(name)
    data = base64.b64encode(path.read_bytes()).decode() if path.exists() else None
    return {"name": name, "webp": data}


def about(name: str) -> dict[str, str]:
    """Facts of a lens of the library that a page lists beside its drawing, by label."""
    entry = next(one for one in entries() if one.name == name)
    film = f"{entry.format.replace('x', ' × ')} mm" if entry.format else ""
    rows = {
        "Maker": entry.maker,
        "Designer": entry.designer,
        "Year": str(entry.year or ""),
        "Design": entry.type,
        "Made for": film,
        "Source": entry.patent,
    }
    return {label: text for label, text in rows.items() if text}


def found(words: str) -> dict[str, Any]:
    """Names of lenses with all words, best match first; else of the lenses with most words."""
    subjects = [*_IDEAL, *library()]
    names = ranked(words, subjects)
    return {"words": words, "names": names or nearest(words, subjects), "all": bool(names)}


_IDEAL = [
    Subject(name, dict.fromkeys((word.text for word in words_of(name)), 1.0)) for name in IDEAL
]
