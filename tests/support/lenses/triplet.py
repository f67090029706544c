"""A triplet as a lens file has it, for tests that change a member of it."""

from __future__ import annotations

from typing import Any

Data = dict[str, Any]
CROWN, FLINT = {"nd": 1.62041, "vd": 60.32}, {"nd": 1.6727, "vd": 32.25}


def row(kind: str, radius: float | None, thickness: float, semi: float, glass: Any = None) -> Data:
    surface = {"kind": kind, "radius": radius, "thickness": thickness}
    return {**surface, "semi_diameter": semi, "glass": glass}


#: A triplet, f = 47 mm, with an iris behind its second glass.
TRIPLET: Data = {
    "name": "triplet",
    "surfaces": [
        row("spherical", 22.01359, 3.795568, 9.5, CROWN),
        row("spherical", -435.7602, 6.0, 9.5),
        row("spherical", -22.21328, 2.0, 5.0, FLINT),
        row("spherical", 20.29192, 1.0, 5.0),
        row("stop", None, 3.750246, 4.3),
        row("spherical", 79.6836, 2.720573, 7.5, CROWN),
        row("spherical", -18.39533, 40.0, 7.5),
    ],
    "configurations": [{"name": "infinity", "gaps": {}}],
}
