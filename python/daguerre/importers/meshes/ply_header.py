"""Headers of PLY files: elements and their properties.

Source: G. Turk 1994, "The PLY Polygon File Format". Types of 8 bytes and of half precision are not
in it, but in files.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn

import numpy as np

from daguerre.checks import short
from daguerre.errors import InputError
from daguerre.importers.file_bytes import Bytes

#: NumPy's codes of the types.
_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "long": "i8", "ulong": "u8", "int64": "i8", "uint64": "u8",
    "half": "f2", "float16": "f2", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
#: Maximum size of a header, bytes, and number of its properties.
_MOST_BYTES, _MOST_PROPERTIES = 1 << 20, 1000
_MOST_ROWS = (1 << 31) - 1


@dataclass(frozen=True)
class Property:
    """A number of each row of an element, or a list of numbers.

    Attributes:
        name: Name of the property.
        type: NumPy's code of the type, without byte order.
        counted: Code of the type of the length of a list; empty for a single number.
    """

    name: str
    type: str
    counted: str = ""

    @property
    def largest(self) -> int:
        """Largest number of an integer type; 0 for other types."""
        return int(np.iinfo(self.type).max) if self.type[0] in "iu" else 0


@dataclass(frozen=True)
class Element:
    """A table of the file: vertices, faces or something else.

    Attributes:
        name: Name of the element.
        count: Number of rows.
        properties: Columns in the order of the file.
    """

    name: str
    count: int
    properties: tuple[Property, ...]

    def find(self, name: str) -> Property | None:
        """Property of a name."""
        return next((p for p in self.properties if p.name == name), None)


@dataclass(frozen=True)
class Header:
    """Elements and properties of a file, as its header lists them.

    Attributes:
        order: Byte order, "<" or ">"; empty for text.
        elements: Elements in the order of the file.
        size: Bytes of the header.
        lines: Number of its lines.
    """

    order: str
    elements: tuple[Element, ...]
    size: int
    lines: int

    def find(self, name: str) -> Element:
        """Element of a name, which must exist."""
        return next(element for element in self.elements if element.name == name)


def read_header(data: Bytes, where: str) -> Header:
    """Reads the header of a file.

    Raises:
        InputError: The header is not valid PLY 1.0; the message names the line.
    """
    reader = _PlyHeaderReader(where)
    text = data[:_MOST_BYTES].tobytes()
    begin = 0
    while not reader.ended:
        end = text.find(b"\n", begin)
        if end < 0:
            raise InputError(f"{where}: line {reader.line + 1}: end_header is missing")
        reader.read(text[begin:end].decode("latin-1"))
        begin = end + 1
    return reader.header(begin)


class _PlyHeaderReader:
    """Reads the lines of a header."""

    def __init__(self, where: str) -> None:
        self.line, self.ended = 0, False
        self._where = where
        self._order: str | None = None
        self._elements: list[tuple[str, int, list[Property]]] = []
        self._properties = 0

    def header(self, size: int) -> Header:
        """The header, of ``size`` bytes."""
        if self._order is None:
            self._fail("a line format", "none")
        elements = tuple(Element(name, count, tuple(own)) for name, count, own in self._elements)
        return Header(self._order or "", elements, size, self.line)

    def read(self, line: str) -> None:
        """Reads a line."""
        self.line += 1
        words = line.split()
        if self.line == 1:
            if words != ["ply"]:
                self._fail("ply", line)
            return
        match words:
            case [] | ["comment" | "obj_info", *_]:
                return
            case ["format", order, "1.0"] if order in _ORDERS and self._order is None:
                self._order = _ORDERS[order]
            case ["element", name, count]:
                self._element(name, count)
            case ["property", *rest]:
                self._property(rest, line)
            case ["end_header"]:
                self.ended = True
            case _:
                self._fail("format, element, property, comment or end_header", line)

    def _element(self, name: str, count: str) -> None:
        if any(name == other for other, _, _ in self._elements):
            self._fail("each element once", f"{name} again")
        if not (count.isascii() and count.isdecimal() and len(count) < 11):
            self._fail(f"a number of rows up to {_MOST_ROWS}", count)
        if int(count) > _MOST_ROWS:
            self._fail(f"a number of rows up to {_MOST_ROWS}", count)
        self._elements.append((name, int(count), []))

    def _property(self, words: list[str], line: str) -> None:
        if not self._elements:
            self._fail("an element before its properties", line)
        match words:
            case ["list", counted, kind, name] if counted in _TYPES and kind in _TYPES:
                if _TYPES[counted].startswith("f"):
                    self._fail("a whole number as the length of a list", counted)
                found = Property(name, _TYPES[kind], _TYPES[counted])
            case [kind, name] if kind in _TYPES:
                found = Property(name, _TYPES[kind])
            case _:
                self._fail(f"a property of {', '.join(_TYPES)}", line)
        properties = self._elements[-1][2]
        if any(p.name == name for p in properties):
            self._fail("each property once", f"{name} again")
        self._properties += 1
        if self._properties > _MOST_PROPERTIES:
            self._fail(f"at most {_MOST_PROPERTIES} properties", "more")
        properties.append(found)

    def _fail(self, wanted: str, got: str) -> NoReturn:
        raise InputError(f"{self._where}: line {self.line}: wanted {wanted}, got {short(got)}")
