"""Numbers in text, many and fast."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import short

#: Text that is divided into words at a time, bytes: words take 6 times the memory.
_PIECE = 1 << 24
_BLANK = re.compile(rb"\s")


class NotANumberError(ValueError):
    """A word that is not a number.

    Attributes:
        line: Its line in the text, from 0.
        wanted: Words for an error: what belongs here.
        word: The word, for messages.
    """

    def __init__(self, line: int, wanted: str, word: str) -> None:
        super().__init__(f"line {line}: wanted {wanted}, got {word}")
        self.line, self.wanted, self.word = line, wanted, word


def numbers(text: bytes, kind: type[float | int] = float) -> NDArray[Any]:
    """Reads words as numbers.

    Args:
        text: Words with white space between them.
        kind: ``float`` or ``int``.

    Returns:
        Shape (N,), float64 or int64.

    Raises:
        NotANumberError: A word is not a number of this kind.
    """
    found, begin = [], 0
    while begin < len(text):
        end = begin + _PIECE
        if end < len(text):
            blank = _BLANK.search(text, end)
            end = len(text) if blank is None else blank.start()
        piece = text[begin:end]
        words = piece.split()
        try:
            if b"_" in piece:  # which Python allows in numbers
                raise ValueError
            found.append(np.fromiter(map(kind, words), np.dtype(kind), len(words)))
        except (ValueError, OverflowError):
            at = next(one for one in re.finditer(rb"\S+", piece) if not _is(one[0], kind))
            line = text.count(b"\n", 0, begin + at.start())
            wanted = "a number" if kind is float else "a whole number"
            raise NotANumberError(line, wanted, short(at[0].decode("latin-1"))) from None
        begin = end
    return np.concatenate(found) if found else np.zeros(0, np.dtype(kind))


def _is(word: bytes, kind: type[float | int]) -> bool:
    """Whether a word is a number of a kind."""
    try:
        np.array([kind(word)], np.dtype(kind))
    except (ValueError, OverflowError):
        return False
    return b"_" not in word
