"""Elements of an XML text with their places.

Document types are refused, and with them entities, through which a small file can grow without
bounds or read other files.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from xml.parsers import expat

from daguerre.errors import InputError

#: White space before the declaration, which XML forbids and other readers of MaterialX pass over.
_LATE = re.compile(rb"\A(\s+)(<\?xml\b[^>]*\?>)")
#: Comments. XML forbids two hyphens in them; pugixml, which Mitsuba and MaterialX use, does not.
_COMMENT = re.compile(rb"(?<=<!--).*?(?=-->)", re.DOTALL)
#: Code of expat for a text that ends before its root element does, and our words for it.
_ENDS = expat.errors.codes[expat.errors.XML_ERROR_NO_ELEMENTS]
_CUT = "empty or truncated file"
MAX_DEPTH = 64
MAX_ELEMENTS = 1_000_000
MAX_BYTES = 64 << 20


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


@dataclass(eq=False)
class Element:
    """An element of a text; ``line`` and ``column`` are for messages."""

    tag: str
    attributes: dict[str, str]
    line: int
    column: int
    parent: Element | None = None
    children: list[Element] = field(default_factory=list)
    text: list[str] = field(default_factory=list)  # between tags, in pieces

    def get(self, name: str) -> str:
        """Value of an attribute; empty if missing."""
        return self.attributes.get(name, "")

    def inherited(self, name: str) -> str:
        """Value of an attribute of the element, or of the nearest parent that has it."""
        element: Element | None = self
        while element is not None:
            if name in element.attributes:
                return element.attributes[name]
            element = element.parent
        return ""


def parse(data: bytes, file: str) -> Element:
    """Parses the bytes of a file.

    Raises:
        InputError: The bytes are not XML, too large or too deep, or have a document type.
    """
    if len(data) > MAX_BYTES:
        raise InputError(f"{file}: XML: wanted at most {MAX_BYTES} bytes, got {len(data)}")
    data = _LATE.sub(rb"\2\1", data, count=1)
    data = _COMMENT.sub(lambda found: found[0].replace(b"-", b" "), data)
    reader = _ElementReader(file)
    with xml_errors(file):
        reader.parser.Parse(data, True)
    assert reader.root is not None  # expat refuses a text without an element
    return reader.root


class _ElementReader:
    """Builds a tree from the events of expat."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.root: Element | None = None
        self.open: list[Element] = []
        self.count = 0
        self.parser = expat.ParserCreate()
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self.parser.StartDoctypeDeclHandler = self._refuse_type

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        parent = self.open[-1] if self.open else None
        element = Element(tag, attributes, *self._place(), parent)
        self.count += 1
        if len(self.open) >= MAX_DEPTH:
            self._fail(f"nested too deeply: the limit is {MAX_DEPTH} elements")
        if self.count > MAX_ELEMENTS:
            self._fail(f"too many elements: the limit is {MAX_ELEMENTS}")
        if parent is None:
            self.root = element
        else:
            parent.children.append(element)
        self.open.append(element)

    def _end(self, tag: str) -> None:
        self.open.pop()

    def _text(self, text: str) -> None:
        found = self.open[-1].text
        if found or not text.isspace():  # indentation alone is no text
            found.append(text)

    def _refuse_type(self, *about: object) -> None:
        self._fail("document types and entities are not supported, got <!DOCTYPE>")

    def _place(self) -> tuple[int, int]:
        return self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1

    def _fail(self, what: str) -> None:
        line, column = self._place()
        raise InputError(f"{self.file}: XML: line {line}, column {column}: {what}")
