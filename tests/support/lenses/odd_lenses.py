"""Lenses that are valid in form and odd in what they say: equal positions, planes alone, no gaps.

Each stands in every format that can say it. Each must be used, or refused in words.
"""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Iterator
from typing import Any

from . import lens_writers as write
from .triplet import CROWN, FLINT, TRIPLET, Data, row

SCHEMA = "daguerre-lens/0.1"


STOP, LAST = 4, 6


def _positions(*gaps: dict[str, float], **members: Any) -> Data:
    """The triplet with these positions, all with the same further members."""
    listed = [{"name": f"p{i}", "gaps": g, **members} for i, g in enumerate(gaps)]
    return {**copy.deepcopy(TRIPLET), "configurations": listed}


def _near(*distances: float | None, gaps: list[dict[str, float]] | None = None) -> Data:
    """The triplet with positions of focus at these distances, mm; None: infinity."""
    data = _positions(*(gaps or [{"1": 6.0 + 0.1 * i} for i in range(len(distances))]))
    for position, distance in zip(data["configurations"], distances, strict=True):
        if distance is not None:
            position["object_distance_mm"] = distance
    return data


def _with(*changes: tuple[int, Data]) -> Data:
    """The triplet with members of surfaces changed."""
    data = copy.deepcopy(TRIPLET)
    for surface, members in changes:
        data["surfaces"][surface].update(members)
    return data


def _all(**members: Any) -> Data:
    return _with(*((i, members) for i in range(LAST + 1)))


def _stop_at(place: int, gap: float = 1.0) -> Data:
    """The triplet with its iris at another place of the table."""
    data = copy.deepcopy(TRIPLET)
    stop = data["surfaces"].pop(STOP)
    data["surfaces"].insert(place, {**stop, "thickness": gap})
    return data


def _of(*rows: Data) -> Data:
    """Another table."""
    return {**copy.deepcopy(TRIPLET), "surfaces": [copy.deepcopy(row) for row in rows]}


def _mirrored() -> Data:
    """Radii of the other sign: a lens that spreads."""
    data = copy.deepcopy(TRIPLET)
    for surface in data["surfaces"]:
        surface["radius"] = surface["radius"] and -surface["radius"]
    return data


_STOP = row("stop", None, 1.0, 4.0)
_BALL = [row("spherical", 5.0, 10.0, 4.9, CROWN), row("spherical", -5.0, 5.0, 4.9)]
_PLATE = [row("spherical", None, 2.0, 5.0, CROWN), row("spherical", None, 10.0, 5.0)]
_KEPLER = [
    row("spherical", 50.0, 2.0, 5.0, CROWN),
    row("spherical", None, 115.0, 5.0),
    row("spherical", None, 2.0, 5.0, CROWN),
    row("spherical", -50.0, 10.0, 5.0),
]

ODD: dict[str, Data] = {
    # positions
    "two equal positions": _positions({}, {}),
    "three equal positions": _positions({}, {}, {}),
    "equal positions with gaps": _positions({"1": 7.0}, {"1": 7.0}),
    "two of three equal": _positions({}, {"1": 7.0}, {"1": 7.0}),
    "one position twice about another": _positions({}, {"1": 7.0}, {}),
    "positions a hair apart": _positions({}, {"1": 6.0 + 1e-12}),
    "positions that move the film alone": _positions({}, {"6": 41.0}),
    "positions that move nothing that matters": _positions({"4": 3.750246}, {"4": 4.0}),
    "falling positions": _positions({"1": 9.0}, {"1": 7.0}, {"1": 5.0}),
    "positions there and back": _positions({"1": 5.0}, {"1": 9.0}, {"1": 5.5}, {"1": 8.5}),
    "a position through infinity": _positions({}, {"1": 60.0}),
    "positions of gap 0": _positions({"1": 0.0}, {"3": 0.0}),
    "equal f-numbers": _positions({}, {"1": 7.0}, f_number=4.0),
    "stops of another size": _positions({}, {"1": 7.0}, stop_semi_diameter=2.0),
    "a hundred positions": _positions(*({"1": 6.0 + 0.01 * i} for i in range(100))),
    "sixty equal positions": _positions(*({} for _ in range(60))),
    "names twice": {
        **_positions({}, {"1": 7.0}),
        "configurations": [{"name": "a", "gaps": {}}, {"name": "a", "gaps": {"1": 7.0}}],
    },
    "names that are empty": {
        **_positions({}, {"1": 7.0}),
        "configurations": [{"name": "", "gaps": {}}, {"name": "", "gaps": {"1": 7.0}}],
    },
    "focal lengths that are claimed": _positions({}, {"1": 7.0}, efl_mm=1e-3),
    # focus
    "near positions that are equal": _near(None, 500.0, 500.0),
    "near is as infinity": _near(None, 500.0, gaps=[{"1": 6.0}, {"1": 6.0}]),
    "near alone": _near(500.0),
    "near alone, twice": _near(500.0, 500.0),
    "near within the lens": _near(None, 1e-6),
    "near that goes the wrong way": _near(None, 500.0, gaps=[{"1": 6.0}, {"6": 20.0}]),
    "near of two zoom positions that are equal": {
        **copy.deepcopy(TRIPLET),
        "configurations": [
            {"name": "a", "gaps": {}},
            {"name": "b", "gaps": {}},
            {"name": "c", "gaps": {"6": 45.0}, "object_distance_mm": 500.0},
        ],
    },
    "near that touches": _near(None, 500.0, gaps=[{"1": 6.0}, {"1": 0.0, "3": 0.0}]),
    # the iris
    "iris first": _stop_at(0),
    "iris last": _stop_at(LAST, 40.0),
    "iris last, on the film": _stop_at(LAST, 0.0),
    "iris of 1e-9": _with((STOP, {"semi_diameter": 1e-9})),
    "iris of 1e6": _with((STOP, {"semi_diameter": 1e6})),
    "iris without a size": _with((STOP, {"semi_diameter": None})),
    "no sizes": _all(semi_diameter=None),
    "iris on a surface": {
        **copy.deepcopy(TRIPLET),
        "surfaces": [
            {**s, **({"stop": True} if i == 3 else {})}
            for i, s in enumerate(TRIPLET["surfaces"])
            if i != STOP
        ],
    },
    "iris alone": _of(_STOP),
    "iris between planes": _of(_PLATE[0], _PLATE[1], _STOP),
    # thicknesses
    "no thickness": _all(thickness=0.0),
    "no air": _with((1, {"thickness": 0.0}), (3, {"thickness": 0.0}), (STOP, {"thickness": 0.0})),
    "glass without thickness": _with((0, {"thickness": 0.0}), (2, {"thickness": 0.0})),
    "no way to the film": _with((LAST, {"thickness": 0.0})),
    "a film before the lens": _with((LAST, {"thickness": -30.0})),
    "the film a kilometre away": _with((LAST, {"thickness": 1e5})),
    "a kilometre of glass": _with((0, {"thickness": 1e5})),
    "a kilometre of air": _with((1, {"thickness": 9e4})),
    # glass
    "one glass all through": _all(glass=CROWN),
    "same glass twice": _with((1, {"glass": CROWN})),
    "cemented to itself": _with((1, {"glass": CROWN, "thickness": 2.0})),
    "no glass": _all(glass=None),
    "glass like air": _with((0, {"glass": {"nd": 1.0, "vd": 50.0}})),
    "glass behind": _with((LAST, {"glass": CROWN})),
    "glass of all colours": _with((0, {"glass": {"nd": 1.5, "vd": 2.0}})),
    "glass of no colour": _with((0, {"glass": {"nd": 1.5, "vd": 1e9}})),
    "a solid block": _with((1, {"glass": FLINT}), (3, {"glass": CROWN}), (STOP, {"glass": CROWN})),
    # forms
    "planes alone": _all(radius=None),
    "planes of radius 1e15": _all(radius=1e15),
    "a lens that spreads": _mirrored(),
    "a telescope": _of(*_KEPLER, _STOP),
    "a telescope behind its iris": _of(_STOP, *_KEPLER),
    "a ball": _of(_STOP, *_BALL),
    "a ball behind itself": _of(*_BALL, _STOP, *_BALL),
    "half a ball to its rim": _with((0, {"radius": 9.5})),
    "a plate": _of(_STOP, *_PLATE),
    "one surface": _of(row("spherical", 20.0, 50.0, 5.0, CROWN), _STOP),
    "one surface, the iris": _of({**row("spherical", 20.0, 50.0, 5.0, CROWN), "stop": True}),
    "a needle": _all(semi_diameter=1e-6),
    "a conic of -1e6": _with((0, {"kind": "aspheric", "conic": -1e6})),
    "a conic of 1e6": _with((0, {"kind": "aspheric", "conic": 1e6})),
    "an asphere of nothing": _with((0, {"kind": "aspheric", "asphere": {"a4": 0.0}})),
    "an asphere of 1e9": _with((0, {"kind": "aspheric", "asphere": {"a4": 1e9}})),
    "an asphere of power 60": _with((0, {"kind": "aspheric", "asphere": {"a60": 1e-60}})),
    "small as dust": {
        **copy.deepcopy(TRIPLET),
        "surfaces": [
            {
                **s,
                "radius": s["radius"] and 1e-3 * s["radius"],
                "thickness": 1e-3 * s["thickness"],
                "semi_diameter": 1e-3 * s["semi_diameter"],
            }
            for s in TRIPLET["surfaces"]
        ],
    },
    "large as a house": {
        **copy.deepcopy(TRIPLET),
        "surfaces": [
            {
                **s,
                "radius": s["radius"] and 1e3 * s["radius"],
                "thickness": 1e3 * s["thickness"],
                "semi_diameter": 1e3 * s["semi_diameter"],
            }
            for s in TRIPLET["surfaces"]
        ],
    },
    # what is out of the row
    "tilted by 90": _with((0, {"tilt": [90.0, 0.0, 0.0]})),
    "the iris tilted by 89": _with((STOP, {"tilt": [89.0, 0.0, 0.0]})),
    "far aside": _with((0, {"decenter": [1e3, 0.0, 0.0]})),
    "a film seen from the side": _with((LAST, {"tilt": [0.0, 60.0, 0.0]})),
    # words
    "a name of nothing": {**copy.deepcopy(TRIPLET), "name": ""},
    "a name of control characters": {**copy.deepcopy(TRIPLET), "name": "a\0b\x1b[2J\nc\u202e"},
    "NaN as text": _with((0, {"radius": "NaN"})),
    "infinity as text": _with((0, {"thickness": "inf"})),
    "claims of nothing": {**copy.deepcopy(TRIPLET), "nominal": {"efl_mm": 0, "f_number": 0}},
    "claims of 1e30": {
        **copy.deepcopy(TRIPLET),
        "nominal": {"efl_mm": 1e30, "f_number": 1e-30, "image_circle_mm": 1e30},
    },
    "an image circle of dust": {**copy.deepcopy(TRIPLET), "nominal": {"image_circle_mm": 1e-9}},
    "in water": {**copy.deepcopy(TRIPLET), "object_medium": {"nd": 1.333, "vd": 55.8}},
    "in glass of its own": {**copy.deepcopy(TRIPLET), "object_medium": CROWN},
    "a group of everything": {
        **copy.deepcopy(TRIPLET),
        "groups": [{"surfaces": [0, LAST], "tilt": [45.0, 0.0, 0.0]}],
    },
}

_FOREIGN: dict[str, Callable[[Data], str]] = {
    "zmx": write.zmx,
    "seq": write.seq,
    "txt": write.optical_bench,
    "dat": write.pbrt,
}


def files() -> Iterator[tuple[str, str, bytes]]:
    """Name, suffix and bytes of each; a format that cannot say a lens at all is left out."""
    for name, data in ODD.items():
        yield name, "json", json.dumps({"schema": SCHEMA, **data}).encode()
        for suffix, writer in _FOREIGN.items():
            try:
                yield name, suffix, writer(copy.deepcopy(data)).encode()
            except (LookupError, TypeError, ValueError, ArithmeticError):
                continue
