"""Reads the EXIF properties of an XMP packet, by EXIF's names.

Sources: XMP specification, parts 1 and 2 (ISO 16684-1), and CIPA DC-010 (Exif for XMP).
"""

from __future__ import annotations

import re
from typing import Any
from xml.parsers import expat

_RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns# "
_SPACES = (
    "http://ns.adobe.com/tiff/1.0/ ",
    "http://ns.adobe.com/exif/1.0/ ",
    "http://cipa.jp/exif/1.0/ ",
)
#: Names of XMP that differ from EXIF's.
_RENAMED = {
    "ISOSpeedRatings": "PhotographicSensitivity",
    "http://ns.adobe.com/exif/1.0/aux/ Lens": "LensModel",
}
_FRACTION = re.compile(r"([+-]?\d{1,20})(?:/(\d{1,20}))?")
_LONGEST = 4096


def xmp_tags(packet: bytes) -> dict[str, Any] | None:
    """Returns properties of EXIF and TIFF; None if the packet is no XML, or has a document type.

    Returns:
        Numbers; fractions as pairs (numerator, denominator); texts. Of lists the first value.
    """
    reader = _XmpReader()
    try:
        reader.parser.Parse(packet.strip(b"\0 \t\r\n"), True)
    except (expat.ExpatError, LookupError, ValueError):
        return None
    return reader.found


class _XmpReader:
    """Collects properties of ``rdf:Description`` directly below ``rdf:RDF``."""

    def __init__(self) -> None:
        self.found: dict[str, Any] = {}
        self._open: list[str] = []
        self._text = ""
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._more
        self.parser.StartDoctypeDeclHandler = self._refuse

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        if name == f"{_RDF}Description" and self._open[-1:] == [f"{_RDF}RDF"]:
            for key, value in attributes.items():
                self._add(key, value)
        self._open.append(name)
        self._text = ""

    def _more(self, text: str) -> None:
        self._text += text[:_LONGEST]

    def _end(self, name: str) -> None:
        self._open.pop()
        owner = [f"{_RDF}RDF", f"{_RDF}Description"]
        if self._open[-2:] == owner:
            self._add(name, self._text)
        elif name == f"{_RDF}li" and self._open[-4:-2] == owner:
            self._add(self._open[-2], self._text)
        self._text = ""

    def _add(self, name: str, text: str) -> None:
        space, _, short = name.rpartition(" ")
        short = _RENAMED.get(name, _RENAMED.get(short, short))
        if text.strip() and (f"{space} " in _SPACES or name in _RENAMED):
            self.found.setdefault(short, _value(text.strip()[:_LONGEST]))

    def _refuse(self, *about: object) -> None:
        raise ValueError("document types are not supported")


def _value(text: str) -> Any:
    """A whole number, a fraction as a pair, or the text."""
    match = _FRACTION.fullmatch(text)
    if match is None:
        return text
    return int(match[1]) if match[2] is None else (int(match[1]), int(match[2]))
