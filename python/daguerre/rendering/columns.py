"""Columns: words of a film's sums without those that are zero in all pixels, to be sent and added.

Most sums need few of their 128 bits, and most parts of a film few of their sums.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

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
        words: Words of these, pixel by pixel, or all words of lists; flat.
    """

    shape: tuple[int, ...]
    kept: Words
    words: Words


def columns_of(state: Mapping[str, Words]) -> dict[str, Columns]:
    """Columns of ``Session.state``, by part."""
    found = {}
    for part, words in state.items():
        if part == OBJECTS:
            kept, left = np.empty(0, np.uint32), words.reshape(-1)
        else:
            kept, left = _core.word_columns(np.ascontiguousarray(words))
        found[part] = Columns(words.shape, kept, left)
    return found


def add_columns(film: Any, parts: Mapping[str, Columns], where: str) -> None:
    """Adds sums of another film of the same layout.

    Raises:
        MismatchError: A part is missing, unknown or of another size; the film is unchanged then.
        InputError: A list is damaged.
    """
    check_layout(film, {part: one.shape for part, one in parts.items()}, where)
    with core_errors(InputError, where):
        for part, one in parts.items():
            film.add_state(part, one.kept, one.words)
