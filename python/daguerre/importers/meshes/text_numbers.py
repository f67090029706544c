"""Numbers in text, many and fast."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre import _core
from daguerre.checks import short

#: Text that is read at a time, bytes: odd words take 6 times the memory.
_PIECE = 1 << 22
_BLANK = re.compile(rb"\s")


class NotANumberError(ValueError):
    """A word that is not a number.

    Attributes:
        line: Line of the word in the text, from 0.
        wanted: Words for an error: the wanted kind of number.
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
    found = [_piece(text, begin, end, kind) for begin, end in _pieces(text)]
    return np.concatenate(found) if found else np.zeros(0, np.dtype(kind))


def _pieces(text: bytes) -> Iterator[tuple[int, int]]:
    """Where pieces begin and end, between words."""
    begin = 0
    while begin < len(text):
        blank = _BLANK.search(text, begin + _PIECE)
        end = len(text) if blank is None else blank.start()
        yield begin, end
        begin = end


def _piece(text: bytes, begin: int, end: int, kind: type[float | int]) -> NDArray[Any]:
    """Numbers of a piece of text: most by the core, which leaves odd words such as "inf"."""
    read = _core.text_floats if kind is float else _core.text_integers
    values: NDArray[Any]
    values, stopped = read(np.frombuffer(text, np.uint8, end - begin, begin))
    if begin + stopped == end:
        return values
    piece = text[begin + stopped : end]
    words = piece.split()
    try:
        if b"_" in piece:  # which Python allows in numbers
            raise ValueError
        rest = np.fromiter(map(kind, words), np.dtype(kind), len(words))
    except (ValueError, OverflowError):
        at = next(word for word in re.finditer(rb"\S+", piece) if not _is(word[0], kind))
        line = text.count(b"\n", 0, begin + stopped + at.start())
        wanted = "a number" if kind is float else "a whole number"
        raise NotANumberError(line, wanted, short(at[0].decode("latin-1"))) from None
    return np.concatenate([values, rest])


def _is(word: bytes, kind: type[float | int]) -> bool:
    """Whether a word is a number of a kind."""
    try:
        np.array([kind(word)], np.dtype(kind))
    except (ValueError, OverflowError):
        return False
    return b"_" not in word
