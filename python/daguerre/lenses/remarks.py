"""Remarks of a lens file that cannot be used: none of them stops a lens that can be traced.

Texts about the lens and the values that its source states are remarks: the rays do not depend on
them. A clear diameter a little beyond where its surface becomes vertical is a rounded number.
"""

from __future__ import annotations

import math
from typing import Any

from daguerre.files.json_item import Item, clean, short

#: Members that are texts, and members of ``nominal`` that are numbers.
_TEXTS = (*("type", "maker", "designer", "patent", "format", "title_in_source", "note", "suspect"),)
_STATED = ("efl_mm", "efl_x_mm", "f_number", "full_field_deg", "image_circle_mm")
#: Share of its limit that a rounded clear diameter may have: 2 digits have 5 % of 1.0 at most.
_ROUNDED = 1.05
#: Share of the limit to which it is cut, as for diameters that the file lacks.
_CUT = 0.998
_SHOWN = 8


def eased(root: Item) -> tuple[Item, list[str]]:
    """Returns a file's value with remarks that can be used, and a note on each that changed."""
    if not isinstance(root.value, dict):
        return root, []
    value, notes = dict(root.value), []
    for key in _TEXTS:
        if _is_number(value.get(key)):
            value[key] = str(value[key])
        elif not isinstance(value.get(key), str | None):
            notes.append(f"{key}: wanted a string, got {short(value[key])}: ignored")
            value[key] = None
    if isinstance(value.get("nominal"), dict):
        value["nominal"], told = _nominal(value["nominal"])
        notes += told
    if isinstance(value.get("surfaces"), list):
        value["surfaces"], told = _surfaces(value["surfaces"])
        notes += told
    more = len(notes) - _SHOWN
    notes = [*notes[:_SHOWN], *([f"{more} more remarks of the file are changed"] * (more > 0))]
    return root.holding(value), [clean(note) for note in notes]


def _nominal(given: dict[str, Any]) -> tuple[dict[str, Any], list[str]]:
    nominal, notes = dict(given), []
    for key in _STATED:
        stated = nominal.get(key)
        if stated is None or _is_number(stated):
            continue
        first = stated[0] if isinstance(stated, list) and stated else None
        nominal[key] = first if _is_number(first) else None
        used = "ignored" if nominal[key] is None else f"{first:g}, the first, is used"
        notes.append(f"nominal.{key}: wanted one number, got {short(stated)}: {used}")
    return nominal, notes


def _surfaces(given: list[Any]) -> tuple[list[Any], list[str]]:
    surfaces, notes = list(given), []
    for i, one in enumerate(given):
        limit = _limit(one) if isinstance(one, dict) else math.inf
        size: Any = one.get("semi_diameter") if math.isfinite(limit) else None
        if _is_number(size) and limit * (1 + 1e-9) < size <= _ROUNDED * limit:
            surfaces[i] = {**one, "semi_diameter": _CUT * limit}
            notes.append(
                f"surfaces[{i}].semi_diameter: {size:g} is beyond the curvature, which allows "
                f"{limit:.4g} mm: cut to {_CUT * limit:.4g}"
            )
    return surfaces, notes


def _limit(surface: dict[str, Any]) -> float:
    """Height where a sphere or an ellipsoid becomes vertical, mm; infinite for other forms."""
    radius: Any = surface.get("radius")
    conic: Any = surface.get("conic") or 0.0
    if not (_is_number(radius) and _is_number(conic)) or conic <= -1 or surface.get("asphere"):
        return math.inf
    return float(abs(radius) / math.sqrt(1 + conic))


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
