"""Faces of an OBJ file: corners such as 1, 1/2, 1//3 and 1/2/3."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import short
from daguerre.errors import InputError

from .obj_lines import BLANK, Lines, words_of
from .text_numbers import NotANumberError, numbers

Integers = NDArray[np.int64]
_SLASH, _END = ord("/"), ord("\n")
_FIELDS = ("vertex", "texture coordinate", "normal")
#: Lines at a time, so that memory is bounded.
_SOME = 1 << 19


@dataclass(frozen=True, eq=False)
class Faces:
    """Faces with at least 3 corners.

    Attributes:
        sizes: Corners of each, shape (F,).
        points: Vertex of each corner, from 0, shape (C,).
        uv: Texture coordinate of each corner, or -1.
        normals: Normal of each corner, or -1.
        small: Number of faces with fewer corners, which are left out.
    """

    sizes: Integers
    points: Integers
    uv: Integers
    normals: Integers
    small: int


def read_faces(lines: Lines, counts: list[int], where: str) -> Faces:
    """Reads all faces.

    Args:
        lines: Lines of the file.
        counts: Numbers of vertices, texture coordinates and normals.
        where: Owner, for messages.

    Raises:
        InputError: A corner is malformed or has an index out of range; the message names the line.
    """
    chosen = lines.of("f")
    before = [lines.of(word) for word in ("v", "vt", "vn")]
    sizes, corners = [np.zeros(0, np.int64)], [np.zeros((0, 3), np.int64)]
    for begin in range(0, len(chosen), _SOME):
        reader = _FaceReader(lines, chosen[begin : begin + _SOME], where)
        sizes.append(reader.sizes)
        corners.append(reader.resolved(counts, before))
    each, index = np.concatenate(sizes), np.concatenate(corners)
    whole = each >= 3
    small = int((~whole).sum())
    if small:
        index, each = index[np.repeat(whole, each)], each[whole]
    points, uv, normals = index.T
    return Faces(each, points, uv, normals, small)


class _FaceReader:
    """Corners of some lines.

    Attributes:
        sizes: Corners of each line, shape (F,).
    """

    def __init__(self, lines: Lines, chosen: Integers, where: str) -> None:
        self._chosen, self._where = chosen, where
        self._text = lines.bytes(chosen)
        self.sizes = words_of(self._text, len(chosen))
        self._begins: Integers
        self._corners = self._read()

    def _read(self) -> Integers:
        """Numbers of corners as the file has them, shape (C, 3); 0: left out."""
        blank, slash = BLANK[self._text], self._text == _SLASH
        apart = blank | slash
        word, number = ~blank, ~apart
        word[1:] &= blank[:-1]
        number[1:] &= apart[:-1]
        begins, places = np.flatnonzero(word), np.flatnonzero(number)
        slashes = np.cumsum(slash, dtype=np.int32)
        corner = np.searchsorted(begins, places, side="right") - 1
        # A slash before the first number counts, too: a corner with it has no vertex.
        field = slashes[places] - (slashes[begins] - slash[begins])[corner]
        if len(field) and field.max() > 2:
            self._fail(int(corner[int(np.argmax(field))]), begins, "at most 3 numbers per corner")
        values = self._numbers(np.where(slash, np.uint8(ord(" ")), self._text).tobytes())
        if (values == 0).any():
            self._fail(int(corner[int(np.argmin(values != 0))]), begins, "indices of at least 1")
        found = np.zeros((len(begins), 3), np.int64)
        found[corner, field] = values
        if len(found) and (found[:, 0] == 0).any():
            self._fail(int(np.argmin(found[:, 0] != 0)), begins, "a vertex")
        self._begins = begins
        return found

    def _numbers(self, text: bytes) -> Integers:
        try:
            return numbers(text, int)
        except NotANumberError as error:
            raise InputError(
                f"{self._where}: line {self._chosen[error.line] + 1}: f: wanted {error.wanted}, "
                f"got {error.word}"
            ) from None

    def resolved(self, counts: list[int], before: list[Integers]) -> Integers:
        """Indices from 0, shape (C, 3); -1: left out.

        Args:
            counts: Numbers of elements of each table.
            before: Lines of the elements of each table.
        """
        found = np.empty_like(self._corners)
        lines = np.repeat(self._chosen, self.sizes)
        for field, (count, places) in enumerate(zip(counts, before, strict=True)):
            given = self._corners[:, field]
            index = given - 1
            back = given < 0
            if back.any():
                index[back] = np.searchsorted(places, lines[back]) + given[back]
            index[given == 0] = -1
            bad = ((index < 0) | (index >= count)) & (given != 0)
            if bad.any():
                self._fail(int(np.argmax(bad)), self._begins, f"a {_FIELDS[field]} of 1 .. {count}")
            found[:, field] = index
        return found

    def _fail(self, corner: int, begins: Integers, wanted: str) -> NoReturn:
        """Raises the error of a corner."""
        begin = int(begins[corner])
        line = int(self._chosen[int((self._text[:begin] == _END).sum())])
        word = self._text[begin : begin + 60].tobytes().split()[0].decode("latin-1")
        raise InputError(f"{self._where}: line {line + 1}: f: wanted {wanted}, got {short(word)}")
