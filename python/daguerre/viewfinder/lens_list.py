"""Lenses to choose from: the ideal ones, and the library's; all, or those that a search finds."""

from __future__ import annotations

from typing import Any

from daguerre.camera.ideal import IDEAL
from daguerre.lenses.index import entries
from daguerre.lenses.search import Subject, library, nearest, ranked
from daguerre.lenses.words import words_of


def offered() -> list[dict[str, Any]]:
    """All lenses, ideal ones first."""
    ideal = [{"name": name, "title": name, "year": None, "drawn": False} for name in IDEAL]
    return ideal + [
        {"name": one.name, "title": one.title, "year": one.year, "drawn": True} for one in entries()
    ]


def found(words: str) -> dict[str, Any]:
    """Names of lenses that have all words, best match first; else those that have most of them."""
    subjects = [*_IDEAL, *library()]
    names = ranked(words, subjects)
    return {"words": words, "names": names or nearest(words, subjects), "all": bool(names)}


_IDEAL = [
    Subject(name, dict.fromkeys((word.text for word in words_of(name)), 1.0)) for name in IDEAL
]
