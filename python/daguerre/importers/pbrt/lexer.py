"""Splits the text of a scene into words, strings, brackets and lists of numbers.

A list of numbers is read at once by numpy, as meshes may have millions of them.

Source: the text of pbrt-v4's file format, https://pbrt.org/fileformat-v4.
"""

from __future__ import annotations

import re
import warnings
from typing import NoReturn, Protocol

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import short

from .place import FilePlace, SceneFile

FloatArray = NDArray[np.float64]
Values = FloatArray | list[str] | list[bool]

_GAP = re.compile(rb"(?:[ \t\r\n]++|#[^\r\n]*+)*+")
_TOKEN = re.compile(rb'"(?:[^"\\\n]++|\\.)*+"|[\[\]]|[^ \t\r\n"\[\]]++', re.DOTALL)
_WORD = re.compile(rb"[^ \t\r\n]++")
_INCLUDE = re.compile(rb'Include(?=[ \t\r\n"\[\]]|$)')
_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_ESCAPES = {"b": "\b", "f": "\f", "n": "\n", "r": "\r", "t": "\t"}
_OF_NUMBERS = b"0123456789+-.eE \t\r\n"
#: Lists of fewer words are converted word by word, which costs less than checks of the whole.
_FEW = 32
_FLAGS = {b"true": True, b"false": False}


class Includes(Protocol):
    """Opens the files that a text includes."""

    def enter(self, name: str, place: FilePlace) -> SceneFile:
        """Opens a file within the files that are open."""

    def leave(self) -> None:
        """Closes the innermost open file."""


class Lexer:
    """Reads a text token by token, with the texts that it includes in their places.

    ``Include`` may stand anywhere, also between the parameters of a directive.

    Args:
        source: First file.
        includes: Opens further files.
    """

    def __init__(self, source: SceneFile, includes: Includes) -> None:
        self.source = source
        self._includes = includes
        self._outer: list[tuple[SceneFile, int]] = []
        self._data = source.data
        self._next = 0
        #: where the last token begins
        self.offset = 0

    def place(self, directive: str = "") -> FilePlace:
        """Place of the last token."""
        return FilePlace(self.source, self.offset, directive)

    def token(self) -> bytes | None:
        """Returns the next token, with the quotes of a string; None: the file ends.

        Raises:
            InputError: A string does not end on its line.
        """
        start = self._begin()
        if start == len(self._data):
            return None
        found = _TOKEN.match(self._data, start)
        if found is None:
            self.place().fail('unterminated string: no closing " on the same line')
        self._next = found.end()
        return found.group()

    def peek(self) -> bytes:
        """First byte of the next token; empty: the file ends."""
        start = self._begin()
        return self._data[start : start + 1]

    def string(self, place: FilePlace, what: str) -> str:
        """Reads a string.

        Raises:
            InputError: The next token is another.
        """
        token = self.token()
        if token is None or token[:1] != b'"':
            self._lacks(place, f"{what} in quotes", token)
        return text_of(token)

    def number(self, place: FilePlace) -> float:
        """Reads a number.

        Raises:
            InputError: The next token is another.
        """
        token = self.token()
        value = None if token is None else _number(token)
        if value is None:
            self._lacks(place, "a number", token)
        return value

    def values(self, place: FilePlace) -> Values:
        """Reads the value of a parameter: a token, or a list in brackets.

        Raises:
            InputError: The value is missing, the list does not end, or it mixes kinds.
        """
        token = self.token()
        if token is None or token == b"]":
            self._lacks(place, "a value", token)
        if token != b"[":
            return self._of_tokens([(self.offset, token)], place)
        end = self._data.find(b"]", self._next)
        inside = self._data[self._next : end] if end >= 0 else b'"'
        if b'"' in inside or b"#" in inside or _flag_like(inside):
            return self._of_tokens(self._until_bracket(place), place)
        begin, self._next = self._next, end + 1
        return self._numbers(inside, begin, place)

    def _until_bracket(self, place: FilePlace) -> list[tuple[int, bytes]]:
        opened = self.offset
        tokens: list[tuple[int, bytes]] = []
        while True:
            token = self.token()
            if token is None:
                place.at(opened).fail("unterminated list: no closing ]")
            if token == b"]":
                return tokens
            tokens.append((self.offset, token))

    def _of_tokens(self, tokens: list[tuple[int, bytes]], place: FilePlace) -> Values:
        """Makes values of one kind: strings, flags or numbers."""
        if tokens and tokens[0][1][:1] == b'"':
            for offset, token in tokens:
                if token[:1] != b'"':
                    place.at(offset).fail(f"wanted a string, got {_shown(token)}")
            return [text_of(token) for _, token in tokens]
        if tokens and tokens[0][1] in _FLAGS:
            for offset, token in tokens:
                if token not in _FLAGS:
                    place.at(offset).fail(f"wanted true or false, got {_shown(token)}")
            return [_FLAGS[token] for _, token in tokens]
        numbers = []
        for offset, token in tokens:
            value = _number(token)
            if value is None:
                place.at(offset).fail(f"wanted a number, got {_shown(token)}")
            numbers.append(value)
        return np.array(numbers, np.float64)

    def _numbers(self, text: bytes, begin: int, place: FilePlace) -> FloatArray:
        words = text.split()
        found = None
        if not text.translate(None, _OF_NUMBERS):
            found = _few(words) if len(words) < _FEW else _many(text, len(words))
        if found is None or not np.isfinite(found).all():
            for word in _WORD.finditer(text):
                if _number(word.group()) is None:
                    at = place.at(begin + word.start())
                    at.fail(f"wanted a number, got {_shown(word.group())}")
        assert found is not None
        return found

    def _begin(self) -> int:
        """Place of the next token."""
        while True:
            start = self._skip()
            if start == len(self._data) and self._outer:
                self._includes.leave()
                self.source, self._next = self._outer.pop()
                self._data = self.source.data
            elif _INCLUDE.match(self._data, start):
                self._include()
            else:
                return start

    def _include(self) -> None:
        place = self.place("Include")
        self._next += len("Include")
        self._skip()
        found = _TOKEN.match(self._data, self._next)
        if found is None or found.group()[:1] != b'"':
            self._lacks(place, "a name in quotes", None if found is None else found.group())
        self._outer.append((self.source, found.end()))
        self.source = self._includes.enter(text_of(found.group()), place)
        self._data, self._next = self.source.data, 0

    def _skip(self) -> int:
        gap = _GAP.match(self._data, self._next)
        assert gap is not None
        self._next = self.offset = gap.end()
        return self.offset

    def _lacks(self, place: FilePlace, wanted: str, token: bytes | None) -> NoReturn:
        got = "the end of the file" if token is None else _shown(token)
        place.at(self.offset).fail(f"wanted {wanted}, got {got}")


def text_of(token: bytes) -> str:
    """Text of a string in quotes."""
    text = token[1:-1].decode("utf-8", "replace")
    return _ESCAPE.sub(lambda m: _ESCAPES.get(m[1], m[1]), text) if "\\" in text else text


def _flag_like(inside: bytes) -> bool:
    return inside.lstrip()[:1] in (b"t", b"f")


def _number(token: bytes) -> float | None:
    """Value of a number; None: no number, or not finite."""
    if token.translate(None, _OF_NUMBERS):
        return None
    try:
        value = float(token)
    except ValueError:
        return None
    return value if abs(value) < float("inf") else None


def _few(words: list[bytes]) -> FloatArray | None:
    try:
        return np.array([float(word) for word in words], np.float64)
    except ValueError:
        return None


def _many(text: bytes, count: int) -> FloatArray | None:
    """Numbers of a long list; None: not all words are numbers.

    Older numpy stops at the first word that is no number, so the counts are compared.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # DeprecationWarning for text that is no number
        try:
            found = np.fromstring(text.decode("ascii"), np.float64, sep=" ")
        except (DeprecationWarning, ValueError):
            return None
    return found if len(found) == count else None


def _shown(token: bytes) -> str:
    return short(token.decode("utf-8", "replace"), 40)
