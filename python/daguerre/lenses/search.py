"""Search for lenses of the library: ``canon 50 1.2``, ``zeiss wide``, ``70-200``."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from daguerre import errors
from daguerre.argument_checks import guarded
from daguerre.checks import short
from daguerre.errors import UsageError

from .index import Entry, entries, names
from .kinds import BY_ANGLE, kinds_of
from .spelling import is_slip
from .words import Word, words_of

#: Longest text to search for, characters.
MOST = 200
#: Words that say nothing about a lens.
_EMPTY = {"lens", "lenses", "mm", "f", "the", "a", "with"}
#: Scores of a word: it begins a lens's word, is part of it, is misspelt, lies in a zoom's range.
_BEGINS, _PART, _SLIP, _IN_RANGE = 0.8, 0.6, 0.4, 0.7
#: Weights of a lens's words by where they stand.
_TYPE, _KIND, _ALSO, _PATENT = 0.9, 0.9, 0.85, 0.5


@dataclass(frozen=True)
class Subject:
    """Searchable facts of a lens.

    Attributes:
        name: Name of the lens.
        words: Words for the lens, with their weights.
        focal_mm: Shortest and longest focal length, computed and from the title.
        f_numbers: F-numbers, computed and from the title.
        t_numbers: T-numbers of the title.
        sides_mm: Longer and shorter side of the format; None: unknown.
        year: Year of the lens.
        names: Words of the name, and of the title.
    """

    name: str
    words: Mapping[str, float]
    focal_mm: Sequence[tuple[float, float]] = ()
    f_numbers: Sequence[float] = ()
    t_numbers: Sequence[float] = ()
    sides_mm: tuple[float, float] | None = None
    year: int | None = None
    names: Sequence[frozenset[str]] = ()


@guarded
def find(words: str) -> list[Entry]:
    """Finds lenses of the library.

    Each word may be a maker, a part of the name, a focal length (``50``, ``50mm``, ``70-200``), a
    speed (``1.2``, ``f/1.2``), a year or decade (``1970s``), a kind (``zoom``, ``wide``, ``macro``
    and others), a format (``36x24``), a patent, a designer. All words must match, in any order. A
    word that no lens has may have a slip in it (``cannon``).

    Args:
        words: Words, such as "canon 50 1.2"; without any, all lenses are found.

    Returns:
        Lenses with all words, best match first.

    Raises:
        UsageError: The text is too long.
    """
    if len(words) > MOST:
        raise UsageError(
            f"lenses: find: wanted at most {MOST} characters, got {len(words)}: {short(words)}"
        )
    by_name = {entry.name: entry for entry in entries()}
    return [by_name[name] for name in ranked(words, library())]


def suggest(name: object, others: Iterable[str] = ()) -> str:
    """Makes " (did you mean 'a' or 'b'?)" for a lens name that is unknown: found, near, similar.

    Args:
        name: The name.
        others: Allowed names that are not in the library, such as thin.
    """
    text = str(name)[:MOST]
    if not _asked(text):
        return ""
    found = (
        ranked(text, library()) or errors.nearest(text, list(others)) or nearest(text, library())
    )
    return errors.did_you_mean(found) or errors.suggest(text, names())


def ranked(text: str, subjects: Iterable[Subject]) -> list[str]:
    """Names of the lenses that have all words of a text, best match first."""
    listed, words = list(subjects), _asked(text)
    whole = frozenset(_texts(words))
    # A lens with just these words comes before lenses with further words.
    table = {subject.name: float(whole in subject.names) for subject in listed}
    for word in words:
        scores = _scores(word, listed)
        table = {name: table[name] + scores[name] for name in table if scores[name]}
    return _best_first(table)


def nearest(text: str, subjects: Iterable[Subject]) -> list[str]:
    """Names of up to three lenses that have most words of a text, or numbers near them."""
    listed, words = list(subjects), _asked(text)
    table = dict.fromkeys((subject.name for subject in listed), 0.0)
    for word in words:
        scores = _scores(word, listed)
        for subject in listed:
            table[subject.name] += max(scores[subject.name], _nearness(word, subject))
    return [name for name in _best_first(table)[:3] if table[name] >= 0.4 * len(words)]


def _best_first(table: Mapping[str, float]) -> list[str]:
    return sorted(table, key=lambda name: (-round(table[name], 6), name))


@cache
def library() -> tuple[Subject, ...]:
    """The lenses of the library."""
    return tuple(map(_subject, entries()))


def _subject(entry: Entry) -> Subject:
    named = [*words_of(entry.title), *words_of(entry.name)]
    # A compact lens of "telephoto type" may be a wide angle; its angle is known.
    by_angle = {word for kind in BY_ANGLE for word in kind.words}
    weighed = [
        *((word.text, _PATENT) for word in words_of(entry.patent)),
        *((word.text, _ALSO) for word in words_of(f"{entry.also} {entry.designer}")),
        *((word.text, _TYPE) for word in words_of(entry.type) if word.text not in by_angle),
        *((word.text, 1.0) for word in [*named, *words_of(entry.maker)]),
    ]
    words = dict(weighed)
    for kind in kinds_of(entry):
        named_so = not words.keys().isdisjoint(kind.words)
        words |= dict.fromkeys(kind.words, 1.0 if named_so else _KIND)
    sides = words_of(entry.format)
    return Subject(
        name=entry.name,
        words=words,
        focal_mm=[
            (entry.efl_mm, entry.efl_long_mm or entry.efl_mm),
            *_focal_lengths(named, is_zoom=entry.efl_long_mm is not None),
        ],
        f_numbers=[entry.f_number, *(w.f_number for w in named if w.sure and w.f_number)],
        t_numbers=[word.t_number for word in named if word.t_number],
        sides_mm=sides[0].sides_mm if sides else None,
        year=entry.year,
        names=[frozenset(_texts(words_of(name))) for name in (entry.name, entry.title)],
    )


def _focal_lengths(named: Iterable[Word], *, is_zoom: bool) -> list[tuple[float, float]]:
    """Focal lengths in a name; one of ``series-1-135mm``, which has no zoom, spans no range."""
    found = [word.focal_mm for word in named if word.sure and word.focal_mm]
    return [ends for ends in found if is_zoom or ends[0] == ends[1]]


def _texts(words: Iterable[Word]) -> list[str]:
    return [word.text for word in words]


def _asked(text: str) -> list[Word]:
    """Words of a search, each once."""
    return list(dict.fromkeys(word for word in words_of(text) if word.text not in _EMPTY))


def _scores(word: Word, subjects: list[Subject]) -> dict[str, float]:
    """Score of a word for each lens, 0 to 1; slips count if no lens has the word itself."""
    scores = {s.name: max(_as_text(word.text, s), _as_number(word, s)) for s in subjects}
    if any(scores.values()):
        return scores
    slips = _slips(word.text, {own for subject in subjects for own in subject.words})
    return {
        s.name: _SLIP * max((s.words[own] for own in slips & s.words.keys()), default=0.0)
        for s in subjects
    }


def _as_text(text: str, subject: Subject) -> float:
    best = subject.words.get(text, 0.0)
    # 50 is no part of 150; a patent's long number may be given in part.
    if not (text.isalpha() or (text.isdigit() and len(text) > 4)):
        return best
    for own, weight in subject.words.items():
        if text not in own or len(text) < 2:
            continue
        if own.startswith(text):
            best = max(best, _BEGINS * weight)
        elif len(text) > 2:
            best = max(best, _PART * weight)
    return best


def _slips(text: str, known: set[str]) -> set[str]:
    return (
        {own for own in known if own.isalpha() and is_slip(text, own)} if text.isalpha() else set()
    )


def _as_number(word: Word, subject: Subject) -> float:
    """Score of all that a number may mean."""
    year, sides = subject.year, subject.sides_mm
    exact = (
        (word.f_number is not None and any(_same(word.f_number, f) for f in subject.f_numbers))
        or (word.t_number is not None and any(_same(word.t_number, t) for t in subject.t_numbers))
        or (word.years is not None and year is not None and word.years[0] <= year <= word.years[1])
        or (word.sides_mm and sides and all(map(_same, word.sides_mm, sides)))
    )
    if exact:
        return 1.0
    if word.focal_mm is None:
        return 0.0
    return max((_as_focal(word.focal_mm, own) for own in subject.focal_mm), default=0.0)


def _as_focal(asked: tuple[float, float], own: tuple[float, float]) -> float:
    low, high = asked
    if low != high:
        return float(_same(low, own[0]) and _same(high, own[1]))
    if any(_same(low, end) for end in own):
        return 1.0
    return _IN_RANGE if own[0] < low < own[1] else 0.0


def _same(asked: float, own: float) -> bool:
    return abs(asked - own) <= 0.01 * own


def _nearness(word: Word, subject: Subject) -> float:
    """Score of a number that is near a lens's, at most 0.5: half an octave, two stops."""
    near = [0.0]
    if word.focal_mm:
        ends = zip(word.focal_mm, subject.focal_mm[0], strict=True) if subject.focal_mm else ()
        near.append(1 - 2 * max((_octaves(a, b) for a, b in ends), default=1.0))
    if word.f_number:
        near += [1 - _octaves(word.f_number, own) for own in subject.f_numbers]
    return 0.5 * max(near)


def _octaves(a: float, b: float) -> float:
    return abs(math.log2(a / b)) if 0 < a < math.inf else math.inf
