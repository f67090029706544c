"""Values of MaterialX's attributes: numbers, flags, texts, and lengths and angles in units.

Source: MaterialX specification 1.39, chapters "Data Types" and "Units".
"""

from __future__ import annotations

import math

from daguerre.errors import InputError
from daguerre.files.json_item import short
from daguerre.files.xml_elements import Element

from .graph import SIZES

#: Units of length, m, and of angle, degrees.
_METRES = {
    **{"nanometer": 1e-9, "micron": 1e-6, "millimeter": 1e-3, "centimeter": 1e-2, "meter": 1.0},
    **{"kilometer": 1e3, "inch": 0.0254, "foot": 0.3048, "yard": 0.9144, "mile": 1609.344},
}
_UNITS: dict[str, dict[str, float]] = {
    "distance": _METRES,
    "angle": {"degree": 1.0, "radian": math.degrees(1.0)},
}
_FLAGS = {"true": 1.0, "false": 0.0}


def value_of(element: Element, text: str, file: str) -> tuple[float, ...] | str:
    """Parses the value of an input by its type.

    Raises:
        InputError: The text is no value of the type.
    """
    kind = element.get("type")
    size = SIZES.get(kind)
    if size is None:
        return text
    if kind == "boolean" and text.strip() in _FLAGS:
        return (_FLAGS[text.strip()],)
    words = text.replace(",", " ").split()
    numbers = [_number(word) for word in words[: size + 1]]
    found = [number for number in numbers if number is not None]
    if len(found) != size or len(numbers) != size:
        fail(element, file, f"value: wanted {size} finite numbers, got {short(text)}")
    scale = _UNITS.get(element.get("unittype"), {}).get(element.get("unit"), 1.0)
    return tuple(number * scale for number in found)


def fail(element: Element, file: str, what: str) -> None:
    """Raises an error at an element."""
    name = f" {short(element.get('name'))}" if element.get("name") else ""
    raise InputError(f"{file}: line {element.line}: <{element.tag}>{name}: {what}")


def _number(word: str) -> float | None:
    try:
        number = float(word)
    except ValueError:
        return None
    return number if math.isfinite(number) else None
