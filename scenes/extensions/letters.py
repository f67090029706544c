"""A lamp per dot: letters of 3 x 5 dots, each a round lamp of 8 x 8 pixels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# Five rows of three dots, a digit in base 8 each.
_LETTERS = {
    **{"A": "25755", "B": "65656", "C": "34443", "E": "74647", "F": "74644", "H": "55755"},
    **{"I": "72227", "K": "55655", "L": "44447", "N": "65555", "O": "25552", "R": "65655"},
    **{"S": "34216", "T": "72222", "2": "61247", "/": "11244"},
}
_DOT = 8


def written(word: str, upright: bool = False) -> NDArray[np.float64]:
    """A board of lamps, brightness in [0, 1]; `upright` stands letter under letter."""
    letters = [np.pad(dots_of(letter), 1) for letter in word]
    dots = np.concatenate(letters, axis=0 if upright else 1).astype(float)
    y, x = (np.mgrid[0:_DOT, 0:_DOT] + 0.5) / _DOT * 2 - 1
    lamp = np.clip((0.92 - np.hypot(x, y)) * 4, 0, 1)
    return np.kron(dots, lamp)


def dots_of(letter: str) -> NDArray[np.int64]:
    """Dots of a letter, 1 where it has one, shape (5, 3)."""
    return np.array([[int(row) >> bit & 1 for bit in (2, 1, 0)] for row in _LETTERS[letter]])
