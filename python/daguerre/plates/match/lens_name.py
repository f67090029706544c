"""Finds the library's lens from a photograph's lens name, such as "EF24-70mm f/2.8L II USM"."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from daguerre.errors import InputError
from daguerre.lenses.library import Entry, entries

_FOCAL = re.compile(r"(\d+(?:\.\d+)?)(?:\s*-\s*(\d+(?:\.\d+)?))?\s*mm", re.IGNORECASE)
_STOP = re.compile(r"(?<![a-z])[ft]\s*/?\s*(\d+(?:\.\d+)?)", re.IGNORECASE)
#: Relative tolerance of numbers in lens names, such as 50.0 and 2.80.
_SAME = 0.01


@dataclass(frozen=True)
class LensName:
    """Parts of a lens name.

    Attributes:
        focal: Shortest and longest focal length, mm.
        stop: Widest f-stop.
        words: Other words, in lower case.
    """

    focal: tuple[float, float]
    stop: float
    words: frozenset[str]


def parsed(name: str) -> LensName | None:
    """Parses a lens name; None: it has no focal length or no f-stop."""
    focal = _FOCAL.search(name)
    rest = name.replace(focal[0], " ", 1) if focal else name
    stop = _STOP.search(rest)
    if focal is None or stop is None:
        return None
    words = re.findall(r"[a-z]+", rest.replace(stop[0], " ", 1).lower())
    shortest = float(focal[1])
    longest = float(focal[2]) if focal[2] else shortest
    return LensName((shortest, longest), float(stop[1]), frozenset(words))


def library_lens(facts: Mapping[str, Any], where: str) -> tuple[str | None, list[str]]:
    """Finds the library's lens for a photograph's lens name; returns its name or None, and notes.

    Args:
        facts: ``lensModel``, ``lensMake`` and ``cameraMake`` of the photograph.
        where: Name of the photograph, for messages.

    Raises:
        InputError: Several lenses of the library match.
    """
    model = str(facts.get("lensModel") or "")
    if not model:
        return None, []
    if titled := [entry for entry in entries() if entry.title.lower() == model.lower()]:
        return titled[0].name, []
    name = parsed(model)
    alike = [] if name is None else [entry for entry in entries() if _same_numbers(entry, name)]
    if not alike or name is None:
        return None, [f"lens: {model} is not in the library"]
    found, sure = _chosen(alike, name, facts)
    if len(found) > 1:
        names = ", ".join(entry.name for entry in found)
        raise InputError(
            f"{where}: lens: wanted one lens of the library for {model!r}, got {names}; choose one "
            "with --lens"
        )
    if not found:
        names = ", ".join(entry.name for entry in alike)
        return None, [
            f"lens: {model} is not in the library; --lens can set one with the same focal length "
            f"and f-number: {names}"
        ]
    return found[0].name, [] if sure else [f"lens: {model!r} is taken as {found[0].name}"]


def _chosen(
    alike: list[Entry], name: LensName, facts: Mapping[str, Any]
) -> tuple[list[Entry], bool]:
    """Returns the entries that match, and whether all words agree."""
    make = _first(facts.get("lensMake")) or ("" if name.words else _first(facts.get("cameraMake")))
    alike = [entry for entry in alike if not make or make in f"{entry.maker} {entry.title}".lower()]
    same = [entry for entry in alike if _words(entry) == name.words - _maker(entry)]
    if same:
        return same, True
    if not name.words:
        return alike, False
    return [entry for entry in alike if _words(entry) and _words(entry) <= name.words], False


def _same_numbers(entry: Entry, name: LensName) -> bool:
    own = parsed(entry.title)
    if own is None:
        return False
    pairs = zip((*own.focal, own.stop), (*name.focal, name.stop), strict=True)
    return all(abs(a - b) <= _SAME * b for a, b in pairs)


def _words(entry: Entry) -> frozenset[str]:
    own = parsed(entry.title)
    return frozenset() if own is None else own.words - _maker(entry)


def _maker(entry: Entry) -> frozenset[str]:
    return frozenset(re.findall(r"[a-z]+", entry.maker.lower()))


def _first(make: object) -> str:
    """First word of a maker's name: ``nikon`` of NIKON CORPORATION."""
    words = str(make or "").lower().split()
    return words[0] if words else ""
