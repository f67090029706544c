"""Reports members of a lens file that the schema does not have, as they may be typing errors."""

from __future__ import annotations

from collections.abc import Iterator

from daguerre.errors import suggest
from daguerre.files.json_item import Item, clean

from .reading import member

#: Known members by place in the file, including members that no code reads, such as remarks.
KNOWN = {
    "": (
        *("schema", "units", "name", "type", "maker", "designer", "year", "patent", "format"),
        *("title_in_source", "nominal", "object_medium", "coating", "surfaces", "groups"),
        *("configurations", "note", "suspect", "normal_line", "product"),
    ),
    "product": ("closest_focus_m", "magnification", "moves", "source"),
    "nominal": (
        *("efl_mm", "efl_x_mm", "f_number", "full_field_deg", "image_circle_mm", "projection"),
    ),
    "surfaces": (
        *("kind", "radius", "radius_x", "thickness", "semi_diameter", "semi_diameter_after"),
        *("inner_semi_diameter", "glass", "stop", "conic", "conic_x", "asphere", "decenter"),
        *("tilt", "coating", "ripple", "widened_from", "fitted", "note", "from"),
    ),
    "groups": ("name", "surfaces", "decenter", "tilt", "pivot_mm", "note"),
    "configurations": (
        *("name", "gaps", "efl_mm", "efl_x_mm", "f_number", "object_distance_mm", "note"),
        *("object_to_image_m", "stop_semi_diameter", "angle_of_view_deg", "fitted"),
    ),
}
SHOWN = 8


def unknown_members(root: Item) -> list[str]:
    """Returns a note on each of the first few unknown members, and a note with the number left."""
    found = [
        (child, KNOWN[place])
        for place in KNOWN
        for item in _items(root, place)
        for child in item.members()
        if child.key not in KNOWN[place]
    ]
    notes = [
        f"{clean(child.path)}: unknown member, ignored{suggest(str(child.key), known)}"
        for child, known in found[:SHOWN]
    ]
    more = len(found) - SHOWN
    return [*notes, f"{more} more unknown members are ignored"] if more > 0 else notes


def _items(root: Item, place: str) -> Iterator[Item]:
    if not place:
        yield root
        return
    found = member(root, place)
    if found is not None and isinstance(found.value, dict):
        yield found
    elif found is not None:
        yield from (item for item in found if isinstance(item.value, dict))
