"""Values in the elements of Mitsuba's files: numbers, flags, texts, vectors, colours, transforms.

Elements of Mitsuba 0.5 and 0.6 that later versions lack are read, too: ``srgb``, ``blackbody``.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from daguerre.files.json_item import short
from daguerre.files.xml_elements import Element

from .ledger import Entry
from .numbers import numbers
from .transforms import axes

_WHOLE = re.compile(r"\s*[-+]?\d{1,18}\s*\Z", re.ASCII)
_HEX = re.compile(r"\s*#?([0-9a-fA-F]{6})\s*\Z")


def label_of(element: Element) -> str:
    """Element for messages, such as ``<float name="fov">``."""
    for name in ("name", "id", "type"):
        if name in element.attributes:
            return f"<{short(element.tag)[1:-1]} {name}={short(element.get(name), 40)}>"
    return f"<{short(element.tag)[1:-1]}>"


def known(element: Element, entry: Entry, *names: str) -> None:
    """Checks that an element has no other attributes.

    Raises:
        InputError: The element has another attribute.
    """
    for name in element.attributes:
        if name not in names:
            entry.fail(f"wanted attributes {', '.join(names)}, got {short(name)}")


def needed(element: Element, entry: Entry, *names: str) -> list[str]:
    """Attributes of an element, which must have exactly these.

    Raises:
        InputError: The element lacks an attribute, or has another.
    """
    known(element, entry, *names)
    for name in names:
        if name not in element.attributes:
            entry.fail(f"the attribute {name!r} is missing")
    return [element.get(name) for name in names]


def _float(element: Element, entry: Entry) -> float:
    return numbers(needed(element, entry, "name", "value")[1], entry, 1)[0]


def _integer(element: Element, entry: Entry) -> int:
    text = needed(element, entry, "name", "value")[1]
    if not _WHOLE.match(text):
        entry.fail(f"wanted a whole number, got {short(text)}")
    return int(text)


def _boolean(element: Element, entry: Entry) -> bool:
    text = needed(element, entry, "name", "value")[1]
    if text.strip().lower() not in ("true", "false"):
        entry.fail(f"wanted true or false, got {short(text)}")
    return text.strip().lower() == "true"


def _string(element: Element, entry: Entry) -> str:
    return needed(element, entry, "name", "value")[1]


def _point(element: Element, entry: Entry) -> tuple[float, ...]:
    known(element, entry, "name", "x", "y", "z", "value")
    return tuple(axes(element.attributes, entry, 0.0).tolist())


def _rgb(element: Element, entry: Entry) -> tuple[float, ...]:
    known(element, entry, "name", "value", "intent")
    found = numbers(element.get("value"), entry, 1, 3)
    return found * 3 if len(found) == 1 else found


def _srgb(element: Element, entry: Entry) -> tuple[float, ...]:
    known(element, entry, "name", "value", "intent")
    digits = _HEX.match(element.get("value"))
    if digits:
        return tuple(int(digits[1][i : i + 2], 16) / 255 for i in (0, 2, 4))
    return _rgb(element, entry)


def _spectrum(element: Element, entry: Entry) -> tuple[str, str]:
    """Text of the value, and name of a file; either is empty."""
    known(element, entry, "name", "value", "filename", "intent")
    value, file = element.get("value"), element.get("filename")
    if (not value) == (not file):
        entry.fail("wanted an attribute 'value' or 'filename', got both or none")
    return value, file


def _blackbody(element: Element, entry: Entry) -> tuple[float, float]:
    """Temperature, K, and a factor."""
    known(element, entry, "name", "temperature", "scale")
    kelvin = element.get("temperature").strip().rstrip("Kk")
    return numbers(kelvin, entry, 1)[0], numbers(element.get("scale") or "1", entry, 1)[0]


#: Functions that read a value, by the tag of its element.
VALUES: dict[str, Callable[[Element, Entry], Any]] = {
    "float": _float,
    "integer": _integer,
    "boolean": _boolean,
    "string": _string,
    "point": _point,
    "vector": _point,
    "rgb": _rgb,
    "srgb": _srgb,
    "spectrum": _spectrum,
    "blackbody": _blackbody,
}
