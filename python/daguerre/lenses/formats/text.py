"""Decodes text of other programs' lens files to lines with their numbers, and parses words."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import NoReturn

from daguerre.files.json_item import clean, short
from daguerre.lenses.errors import LensError

MAX_LINES = 200_000
MAX_LINE = 100_000
#: Largest magnitude of a number; powers of such numbers stay finite.
MAX_NUMBER = 1e15

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([edED][+-]?\d+)?")
_BINARY = re.compile(r"[\x00-\x08\x0e-\x19\x1b-\x1f\x7f]")


@dataclass(frozen=True)
class Line:
    """One line, or one command of a line.

    Attributes:
        file: Name of the file.
        number: Line number, from 1.
        words: Words of the line or command.
    """

    file: str
    number: int
    words: tuple[str, ...]

    def fail(self, message: str, code: str = "lens-format", surface: int | None = None) -> NoReturn:
        """Raises ``LensError`` for this line, and a surface by its number in the file."""
        where = "" if surface is None else f" surface {surface}:"
        message = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in message)
        raise LensError(f"{self.file}: line {self.number}:{where} {message}", code, surface)

    def word(self, index: int, what: str) -> str:
        """The word at an index; it must be there."""
        if index >= len(self.words):
            self.fail(f"{self.name}: {what}: missing")
        return self.words[index]

    @property
    def name(self) -> str:
        """First word, in printable form."""
        return clean(self.words[0])[:20] if self.words else "line"

    def number_at(
        self,
        index: int,
        what: str,
        low: float = -MAX_NUMBER,
        high: float = MAX_NUMBER,
        *,
        default: float | None = None,
    ) -> float:
        """The finite number at an index; without a default, it must be there."""
        if default is not None and index >= len(self.words):
            return default
        return self.to_number(self.word(index, what), what, low, high)

    def to_number(
        self, word: str, what: str, low: float = -MAX_NUMBER, high: float = MAX_NUMBER
    ) -> float:
        """A word of this line as a number in [low, high]."""
        value = number(word)
        if value is None:
            self.fail(f"{self.name}: {what}: wanted a number, got {short(clean(word))}")
        if not low <= value <= high:
            self.fail(
                f"{self.name}: {what}: out of range: wanted {low:g} .. {high:g}, got {value:g}"
            )
        return value

    def whole_at(self, index: int, what: str, low: int, high: int) -> int:
        """The whole number at an index, in [low, high]."""
        value = self.number_at(index, what, low, high)
        if value != int(value):
            self.fail(f"{self.name}: {what}: wanted a whole number, got {value:g}")
        return int(value)


def number(word: str) -> float | None:
    """Parses a finite number as these programs write it (``1.5D-3`` too); None: not a number."""
    if not _NUMBER.fullmatch(word) or len(word) > 400:
        return None
    value = float(word.replace("D", "e").replace("d", "e"))
    return value if math.isfinite(value) else None


def decoded(data: bytes, file: str) -> str:
    """Decodes UTF-8, UTF-16 (also without a byte order mark) or Latin-1.

    Raises:
        LensError: The file is empty, is not text, or has too many lines.
    """
    text = _decoded(data, file)
    if not text.strip("\x1a \t\r\n\f\v"):
        raise LensError(f"{file}: empty file", "lens-format")
    binary = _BINARY.search(text)
    if binary is not None:
        raise LensError(
            f"{file}: lens file: wanted text, got byte 0x{ord(binary[0]):02x} at character "
            f"{binary.start()}",
            "lens-format",
        )
    return text


def _decoded(data: bytes, file: str) -> str:
    utf16 = {b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be"}.get(data[:2])
    if utf16 is None and data[:4].count(0) == 2:
        utf16 = "utf-16-be" if data[0] == 0 else "utf-16-le"
    if utf16 is not None:
        try:
            return data.decode(utf16).lstrip("\ufeff")
        except UnicodeDecodeError as error:
            raise LensError(
                f"{file}: lens file: wanted UTF-16, got a broken character at byte {error.start}",
                "lens-format",
            ) from None
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def lines_of(text: str, file: str) -> list[str]:
    """Splits text into lines; too many or too long lines are an error."""
    if text.count("\n") + text.count("\r") > 2 * MAX_LINES:
        raise LensError(
            f"{file}: lens file: wanted at most {MAX_LINES} lines, got {text.count(chr(10))}",
            "lens-format",
        )
    lines = re.split(r"\r\n|\r|\n", text)
    for i, line in enumerate(lines):
        if len(line) > MAX_LINE:
            raise LensError(
                f"{file}: line {i + 1}: wanted at most {MAX_LINE} characters, got {len(line)}",
                "lens-format",
            )
    return lines


def words(text: str) -> frozenset[str]:
    """Splits a text into a set of words."""
    return frozenset(text.split())


class Unread:
    """Collects the places of content that an import ignores or changes, for a note on each kind."""

    def __init__(self) -> None:
        self._places: dict[str, list[str]] = {}

    def add(self, what: str, place: str = "") -> None:
        """Adds a note, and a place where it applies."""
        places = self._places.setdefault(clean(what), [])
        if place and place not in places and len(places) < 12:
            places.append(place)

    def add_fields(self, size: float, unit: str) -> None:
        """Adds a note on the fields of a file, of up to this size."""
        if size > 0:
            self.add(f"fields up to {size:.6g} {unit} do not set the frame; the sensor does")

    def notes(self) -> list[str]:
        """Notes, each with its places; at most 40, then their number."""
        rows = [f"{what} ({', '.join(p)})" if p else what for what, p in self._places.items()]
        return rows[:40] + ([f"{len(rows) - 40} more such notes"] if len(rows) > 40 else [])
