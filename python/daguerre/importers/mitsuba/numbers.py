"""Numbers in the attributes of Mitsuba's files, separated by blanks and commas."""

from __future__ import annotations

import re

from .ledger import Entry

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\Z", re.ASCII)
_SEPARATORS = re.compile(r"[,\s]+")
#: Most numbers of an attribute.
MAX_NUMBERS = 1 << 16


def words(text: str) -> list[str]:
    """Words between separators."""
    return [word for word in _SEPARATORS.split(text) if word]


def number(word: str, entry: Entry) -> float:
    """A finite number.

    Raises:
        InputError: The word is none.
    """
    if not _NUMBER.match(word) or not abs(value := float(word)) < float("inf"):
        entry.fail(f"wanted a number, got {word[:40]!r}")
    return value


def numbers(text: str, entry: Entry, *counts: int) -> tuple[float, ...]:
    """Numbers; their count is in ``counts``, or any if empty.

    Raises:
        InputError: A word is no number, or there are more or fewer.
    """
    found = words(text)
    if len(found) > MAX_NUMBERS or (counts and len(found) not in counts):
        wanted = " or ".join(map(str, counts)) if counts else f"at most {MAX_NUMBERS}"
        entry.fail(f"wanted {wanted} numbers, got {len(found)}")
    return tuple(number(word, entry) for word in found)
