"""Lines of an OBJ file by their keyword."""

from __future__ import annotations

from collections import Counter

import numpy as np
from numpy.typing import NDArray

from daguerre.importers.file_bytes import Bytes

Integers = NDArray[np.int64]
_END, _SPACE, _HASH = ord("\n"), ord(" "), ord("#")
#: Whether a byte is white space.
BLANK = np.zeros(256, bool)
BLANK[[*b" \t\r\n\v\f"]] = True
#: Leading blanks of lines that are skipped all at once.
_INDENT = 64


class Lines:
    """Lines of a file.

    Args:
        data: Bytes of the file.
    """

    def __init__(self, data: Bytes) -> None:
        self._data = _plain(data)
        ends = np.flatnonzero(self._data == _END)
        self._begins = np.concatenate([[0], ends[:-1] + 1]) if len(ends) else ends
        self._ends = ends
        first = self._first()
        padded = np.concatenate([self._data, np.full(3, _END, np.uint8)])
        self._letters = [padded[first + k] for k in range(3)]
        self._words = first

    def of(self, word: str) -> Integers:
        """Numbers of the lines, from 0, that begin with a keyword of one or two letters."""
        found = BLANK[self._letters[len(word)]]
        for letter, wanted in zip(self._letters, word.encode(), strict=False):
            found &= letter == wanted
        return np.flatnonzero(found)

    def bytes(self, lines: Integers) -> Bytes:
        """Lines, given in rising order, with blanks instead of their keyword."""
        if not len(lines):
            return np.zeros(0, np.uint8)
        first, last = self._begins[lines[0]], self._ends[lines[-1]] + 1
        begins, ends = self._begins[lines] - first, self._ends[lines] + 1 - first
        out = self._data[first:last].copy()
        if len(lines) <= lines[-1] - lines[0]:  # other lines are between them
            steps = np.zeros(len(out) + 1, np.int8)
            steps[begins] += 1
            steps[ends] -= 1
            out = out[np.cumsum(steps[:-1], dtype=np.int8) > 0]
        sizes = ends - begins
        words = np.cumsum(sizes) - sizes + self._words[lines] - first - begins
        out[words] = _SPACE
        second = ~BLANK[out[words + 1]]
        out[words[second] + 1] = _SPACE
        return out

    def others(self) -> list[tuple[str, int]]:
        """Keywords of lines that hold no vertices or faces, with the number of lines."""
        rest = ~BLANK[self._letters[0]] & (self._letters[0] != _HASH)
        for word in ("v", "vt", "vn", "f"):
            rest[self.of(word)] = False
        found: Counter[str] = Counter()
        for line in np.flatnonzero(rest):
            begin = int(self._words[line])
            text = self._data[begin : min(begin + 40, int(self._ends[line]))].tobytes()
            found[text.split()[0].decode("latin-1")] += 1
        return list(found.items())

    def _first(self) -> Integers:
        """First byte of each line that is not blank, or its end."""
        first = self._begins.copy()
        left = np.arange(len(first))
        for _ in range(_INDENT):
            left = left[BLANK[self._data[first[left]]] & (first[left] < self._ends[left])]
            if not len(left):
                return first
            first[left] += 1
        for line in left:  # rare
            text = self._data[first[line] : self._ends[line]].tobytes()
            first[line] += len(text) - len(text.lstrip())
        return first


def words_of(text: Bytes, lines: int) -> Integers:
    """Number of words of each line of a text that has ``lines`` of them."""
    if not lines:
        return np.zeros(0, np.int64)
    blank = BLANK[text]
    begins = np.concatenate([[0], np.flatnonzero(text == _END)[:-1] + 1])
    word = ~blank
    word[1:] &= blank[:-1]
    places = np.searchsorted(np.flatnonzero(word), begins)
    return np.diff(places, append=np.count_nonzero(word))


def _plain(data: Bytes) -> Bytes:
    """Bytes that end with a line, without comments behind statements and continued lines."""
    text = data.tobytes()
    if b"\n" not in text:
        text = text.replace(b"\r", b"\n")
    if b"\\" in text:  # a line goes on after a backslash at its end
        text = text.replace(b"\\\r\n", b"   ").replace(b"\\\n", b"  ")
    if not text.endswith(b"\n"):
        text += b"\n"
    found = np.frombuffer(text, np.uint8).copy()
    if b"#" in text:
        _blank_comments(found)
    return found


def _blank_comments(text: Bytes) -> None:
    """Replaces comments, from # to the end of a line, by blanks."""
    begins = np.flatnonzero(text == _HASH)
    ends = np.flatnonzero(text == _END)
    behind = ends[np.searchsorted(ends, begins)]
    steps = np.zeros(len(text) + 1, np.int32)
    np.add.at(steps, begins, 1)
    np.add.at(steps, behind, -1)
    text[np.cumsum(steps[:-1]) > 0] = _SPACE
