"""Parser of OpenCV's XML for values with their place.

Source: OpenCV, ``cv::FileStorage`` (modules/core/doc and src/persistence_xml.cpp): a name is an
element, the elements of a list are called ``_``, and text between blanks is numbers, or words
in quotes.
"""

from __future__ import annotations

import re
from typing import Any

from daguerre.errors import InputError

from .json_item import Item
from .xml_elements import Element, xml_errors
from .xml_elements import parse as parse_elements

ROOT = "opencv_storage"
_WORDS = re.compile(r'"[^"]*"|\S+')
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?\Z|[-+]?\.(?:inf|nan)\Z", re.I)


def parse(data: bytes, file: str) -> Item:
    """Parses the bytes of a file.

    Raises:
        InputError: The bytes are not OpenCV's XML, or have features that calibrations do not need.
    """
    root = parse_elements(data, file)
    if root.tag != ROOT:
        raise InputError(f"{file}: XML: wanted <{ROOT}>, as OpenCV writes it, got <{root.tag}>")
    with xml_errors(file):
        return Item(_value(root, file), file)


def _value(element: Element, file: str) -> Any:
    """Value of an element: members by name, a list, or its text."""
    members = element.children
    if not members:
        return _said("".join(element.text))
    if all(member.tag == "_" for member in members):
        return [_value(member, file) for member in members]
    found: dict[str, Any] = {}
    for member in members:
        if member.tag in found and member.tag != "_":
            place = f"line {member.line}, column {member.column}"
            raise InputError(f"{file}: XML: {place}: <{member.tag}> appears twice")
        found[member.tag] = _value(member, file)
    if element.tag == "data" or not isinstance(found.get("data"), int | float):
        return found
    return {**found, "data": [found["data"]]}  # a matrix of one number


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
