"""Words of an unfinished line of bash."""

from __future__ import annotations

from typing import NamedTuple

from .answer import REDIRECT


class Line(NamedTuple):
    """An unfinished command line.

    Attributes:
        before: Words before that at the cursor, without quotes; redirections are left out.
        current: Word at the cursor, without quotes.
        kept: Beginning of it that bash keeps, as its words begin after ``=``, ``:`` and the like.
    """

    before: list[str]
    current: str
    kept: str


def split(line: str, breaks: str) -> Line:
    """Splits a line up to the cursor.

    Args:
        line: The line.
        breaks: Characters at which bash begins a new word: its COMP_WORDBREAKS.
    """
    words: list[str] = []
    word: str | None = None
    cut, before_quote, quote, escaped = 0, 0, "", False
    for c in line:
        if escaped:
            word, escaped = (word or "") + c, False
        elif c == "\\" and quote != "'":
            escaped = True
        elif quote:
            if c == quote:
                quote, cut = "", before_quote
            else:
                word = (word or "") + c
        elif c in "\"'":
            word = word or ""
            quote, before_quote, cut = c, cut, len(word)
        elif c.isspace() or c in REDIRECT:
            words += [] if word is None else [word]
            words += [c] if c in REDIRECT else []
            word, cut = None, 0
        else:
            word = (word or "") + c
            cut = len(word) if c in breaks else cut
    return Line(_without_redirections(words), word or "", (word or "")[:cut])


def _without_redirections(words: list[str]) -> list[str]:
    """Words without redirections; keeps a redirection at the end without a file yet."""
    kept: list[str] = []
    for i, word in enumerate(words):
        redirected = i > 0 and words[i - 1] in REDIRECT
        if (word not in REDIRECT or i == len(words) - 1) and not redirected:
            kept.append(word)
    return kept
