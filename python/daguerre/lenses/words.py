"""Words of a search for lenses, as people and makers write them: ``EF24-70mm f/2.8L``."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from functools import lru_cache

_NUMBER = r"\d+(?:\.\d+)?"
_MM = {"": 1.0, "mm": 1.0, "cm": 10.0, "in": 25.4, "inch": 25.4, "inches": 25.4}
_UNIT = "mm|cm|inches|inch|in"
#: Replacements that leave one form of each number.
_FORMS = [
    (re.compile(pattern), form)
    for pattern, form in (
        (r"(?<=\d),(?=\d{3}(?!\d))", ""),  # thousands of a patent's number
        (r"(?<![\d.])(\d),(\d{1,2})(?![\d.])", r"\1.\2"),  # decimal comma
        (r"\b1:(?=\d)", "f"),  # 1:1.2
        (r"\b([ft])\s*/?\s*(?=\d)", r"\1"),  # f/1.2
        (r"\bex(?:ample)?\.?\s*(?=\d)", "e"),  # Ex. 1 of a patent
        (r"(?<=\d)\s*[-\u2013\u2014]\s*(?=\d)", "-"),  # 24 - 70
        (r"(?<=\d)\s*[x\u00d7*]\s*(?=\d)", "x"),  # 36 x 24
        (rf"(?<=\d)[\s-]*({_UNIT})\b", r"\1"),  # 50 mm
        (r"([a-z]{2,})(?=\d)", r"\1 "),  # EF24
        (rf"(?<=\d)(?!(?:{_UNIT}|s)\b|x\d)(?=[a-z])", " "),  # 2.8L
    )
]
_WORD = re.compile(rf"[a-z]?{_NUMBER}(?:[-x]{_NUMBER})?(?:{_UNIT}|s)?|[^\W\d_]+")
_FOCAL = re.compile(rf"({_NUMBER})(?:-({_NUMBER}))?({_UNIT})?")
_STOP = re.compile(rf"([ft])({_NUMBER})")
_SIDES = re.compile(rf"({_NUMBER})x({_NUMBER})(?:mm)?")
_DECADE = re.compile(r"(\d{2})?(\d0)s")


@dataclass(frozen=True)
class Word:
    """A word, with all that it may mean.

    Attributes:
        text: The word in lower case, without accents.
        sure: Whether a number has the sign of its unit, such as ``50mm``.
        focal_mm: Shortest and longest focal length.
        f_number: F-number.
        t_number: T-number.
        sides_mm: Longer and shorter side of a format.
        years: First and last year.
    """

    text: str
    sure: bool = False
    focal_mm: tuple[float, float] | None = None
    f_number: float | None = None
    t_number: float | None = None
    sides_mm: tuple[float, float] | None = None
    years: tuple[int, int] | None = None


@lru_cache(1024)
def words_of(text: str) -> tuple[Word, ...]:
    """Splits a text into words."""
    folded = unicodedata.normalize("NFKD", text.casefold())
    folded = "".join(sign for sign in folded if not unicodedata.combining(sign))
    for pattern, form in _FORMS:
        folded = pattern.sub(form, folded)
    return tuple(map(_word, _WORD.findall(folded)))


def _word(text: str) -> Word:
    if found := _STOP.fullmatch(text):
        number = float(found[2])
        stop, t_stop = (number, None) if found[1] == "f" else (None, number)
        return Word(text, sure=True, f_number=stop, t_number=t_stop)
    if found := _SIDES.fullmatch(text):
        short, long = sorted((float(found[1]), float(found[2])))
        return Word(text, sure=True, sides_mm=(long, short))
    if found := _DECADE.fullmatch(text):
        first = int((found[1] or "19") + found[2])
        return Word(text, sure=True, years=(first, first + 9))
    if found := _FOCAL.fullmatch(text):
        scale = _MM[found[3] or ""]
        ends = (scale * float(found[1]), scale * float(found[2] or found[1]))
        bare = not found[3] and not found[2]
        years = (int(text), int(text)) if bare and re.fullmatch(r"1[89]\d\d|20\d\d", text) else None
        return Word(
            text,
            sure=bool(found[3]),
            focal_mm=ends,
            f_number=ends[0] if bare else None,
            years=years,
        )
    return Word(text)
