"""Columns: words of a film's sums without those that are zero in all pixels, to be sent and added.

Most sums need few of their 128 bits, and most parts of a film few of their sums.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.errors import InputError, core_errors

from .film_frame import OBJECTS, check_layout

Words = NDArray[np.uint32]


@dataclass(frozen=True)
class Columns:
    """A part of a film's sums.

    Attributes:
        shape: Shape of all words, (H, W, words).
        kept: Columns of the last axis that are kept, rising; none for lists of objects.
        words: Words of these, pixel by pixel, or all words of lists; flat, and not always aligned.
    """

    shape: tuple[int, ...]
    kept: Words
    words: Words


def kept_of(part: str, words: Words) -> tuple[Words, int]:
    """Columns of a part of ``Session.state`` that are kept, and the number of their words."""
    if part == OBJECTS:
        return np.empty(0, np.uint32), words.size
    kept = _core.used_columns(words)
    return kept, words.shape[0] * words.shape[1] * len(kept)


def take(part: str, words: Words, kept: Words, to: Words) -> None:
    """Writes the words of these columns to a flat array."""
    if part == OBJECTS:
        to[:] = words.reshape(-1)
    else:
        _core.take_columns(words, kept, to)


def columns_of(state: Mapping[str, Words]) -> dict[str, Columns]:
    """Columns of ``Session.state``, by part."""
    found = {}
    for part, words in state.items():
        kept, count = kept_of(part, words)
        found[part] = Columns(words.shape, kept, np.empty(count, np.uint32))
        take(part, words, kept, found[part].words)
    return found


def add_columns(film: _core.Film, parts: Mapping[str, Columns], where: str) -> None:
    """Adds sums of another film of the same layout.

    Raises:
        MismatchError: A part is missing, unknown or of another size; the film is unchanged then.
        InputError: A list is damaged.
    """
    check_layout(film, {part: columns.shape for part, columns in parts.items()}, where)
    with core_errors(InputError, where):
        for part, columns in parts.items():
            film.add_state(part, columns.kept, columns.words.view(np.uint8))
