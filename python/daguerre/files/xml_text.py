"""Parser of OpenCV's XML for values with their place.

It refuses document types, and with them entities, through which a small file can grow without
bounds or read other files. OpenCV writes none.

Source: OpenCV, ``cv::FileStorage`` (modules/core/doc and src/persistence_xml.cpp): a name is an
element, the elements of a list are called ``_``, and text between blanks is numbers, or words
in quotes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from xml.parsers import expat

from daguerre.errors import InputError

from .json_item import Item

ROOT = "opencv_storage"
MAX_DEPTH = 64
#: Code of expat for a text that ends before its root element does, and our words for it.
_ENDS = expat.errors.codes[expat.errors.XML_ERROR_NO_ELEMENTS]
_CUT = "empty or truncated file"
_WORDS = re.compile(r'"[^"]*"|\S+')
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\Z|[-+]?\.(?:inf|nan)\Z", re.I)


@contextmanager
def xml_errors(file: str) -> Iterator[None]:
    """Turns errors of expat, and of values that are read meanwhile, into ``InputError``."""
    try:
        yield
    except expat.ExpatError as error:
        place = f"line {error.lineno}, column {error.offset + 1}"
        reason = _CUT if error.code == _ENDS else expat.ErrorString(error.code)
        raise InputError(f"{file}: XML: {place}: {reason}") from None
    except InputError:
        raise
    except (LookupError, ValueError) as error:  # an encoding that nobody knows; huge numbers
        raise InputError(f"{file}: XML: {error}") from None


def parse(data: bytes, file: str) -> Item:
    """Parses the bytes of a file.

    Raises:
        InputError: The bytes are not OpenCV's XML, or have features that calibrations do not need.
    """
    reader = _XmlReader(file)
    with xml_errors(file):
        reader.parser.Parse(data, True)
        value = None if reader.root is None else reader.root.value()
    if reader.root is None or reader.root.name != ROOT:
        found = "nothing" if reader.root is None else f"<{reader.root.name}>"
        raise InputError(f"{file}: XML: wanted <{ROOT}>, as OpenCV writes it, got {found}")
    return Item(value, file)


class _Element:
    """An element that is being read."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.text: list[str] = []
        self.members: list[_Element] = []
        self.names: set[str] = set()

    def value(self) -> Any:
        """Value of the element: members by name, a list, or its text."""
        if not self.members:
            return _said("".join(self.text))
        if all(member.name == "_" for member in self.members):
            return [member.value() for member in self.members]
        found = {member.name: member.value() for member in self.members}
        if self.name == "data" or not isinstance(found.get("data"), int | float):
            return found
        return {**found, "data": [found["data"]]}  # a matrix of one number


class _XmlReader:
    """Builds a tree from the events of expat."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.root: _Element | None = None
        self.open: list[_Element] = []
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self.parser.StartDoctypeDeclHandler = self._refuse_type

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        element = _Element(name)
        if len(self.open) >= MAX_DEPTH:
            self._fail("nested too deeply")
        if not self.open:
            self.root = element
        else:
            parent = self.open[-1]
            if name != "_" and name in parent.names:
                self._fail(f"<{name}> appears twice")
            parent.members.append(element)
            parent.names.add(name)
        self.open.append(element)

    def _end(self, name: str) -> None:
        self.open.pop()

    def _text(self, text: str) -> None:
        self.open[-1].text.append(text)

    def _refuse_type(self, *about: object) -> None:
        self._fail("document types and entities are not supported, got <!DOCTYPE>")

    def _fail(self, what: str) -> None:
        line, column = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        raise InputError(f"{self.file}: XML: line {line}, column {column}: {what}")


def _said(text: str) -> Any:
    """Parses text to a number, text, or a list of both."""
    words = _WORDS.findall(text)
    if not words or not all(_NUMBER.match(word) or _is_quoted(word) for word in words):
        return text.strip()
    said = [word[1:-1] if _is_quoted(word) else _number(word) for word in words]
    return said[0] if len(said) == 1 else said


def _is_quoted(word: str) -> bool:
    return len(word) > 1 and word[0] == word[-1] == '"'


def _number(word: str) -> int | float:
    plain = word.lower().replace(".inf", "inf").replace(".nan", "nan")
    return int(plain) if re.fullmatch(r"[-+]?\d+", plain) else float(plain)
