"""Primitives that are refused, and shapes that are odd but drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tests.support.formats.make_gltf import Builder

from .bases import full, seen
from .case import Case, Change, both, drawn, floats, primitive, put, scenes

P = r"meshes\[0\]\.primitives\[0\]"
A = P + r"\.attributes"
NAN, INF = math.nan, math.inf


def corners(*points: Sequence[float]) -> Change:
    """The four vertices of the wall stand elsewhere."""
    flat = [x for point in points for x in point]
    return both(*(floats(0, i, x) for i, x in enumerate(flat)))


def times(factor: float) -> Change:
    """The wall in another size."""
    return corners(*([2 * factor * x, 2 * factor * y, 0] for x, y in WALL))


WALL = [(-1, -1), (1, -1), (1, 1), (-1, 1)]


def alone(key: str) -> Change:
    """Without this attribute."""
    return put("meshes.0.primitives.0.attributes." + key, ...)


def shining(b: Builder) -> None:
    """The wall is a lamp."""
    b.json["materials"][0]["emissiveFactor"] = [1, 1, 1]


def indices(*numbers: int) -> Change:
    return primitive("indices", lambda b: b.accessor(numbers, "u4"))


def many_degenerate(b: Builder) -> None:
    """A hundred thousand triangles that are points, all of them lamps."""
    shining(b)
    indices(*([0] * 300_000))(b)


def many_primitives(b: Builder) -> None:
    b.json["meshes"][0]["primitives"] *= 5000


BAD: dict[str, tuple[Change, str]] = {
    "no primitives": (put("meshes.0", {}), r"meshes\[0\]\.primitives: missing"),
    "attributes is a list": (put("meshes.0.primitives.0.attributes", []), A + ": wrong type"),
    "mode 7": (put("meshes.0.primitives.0.mode", 7), P + r"\.mode: unknown value"),
    "position out of range": (
        primitive("POSITION", lambda b: 31),
        A + r"\.POSITION: index out of range: wanted 0 \.\. \d \(accessors\), got 31",
    ),
    "position of pairs": (
        primitive("POSITION", lambda b: b.accessor([[0, 0]] * 3)),
        A + r"\.POSITION: wrong accessor type: wanted VEC3, got VEC2",
    ),
    "position NaN": (
        floats(0, 4, float("nan")),
        A + r"\.POSITION: vertex 1: wanted finite numbers, got \[1\.0, nan, 0\.0\]",
    ),
    "position far": (floats(0, 0, 1e30), A + r"\.POSITION: vertex 0: wanted coordinates below"),
    "position Inf": (floats(0, 0, float("inf")), A + r"\.POSITION: vertex 0: wanted finite"),
    "normal NaN": (floats(2, 8, float("nan")), A + r"\.NORMAL: vertex 2: wanted finite"),
    "uv NaN": (floats(3, 1, float("nan")), A + r"\.TEXCOORD_0: vertex 0: wanted finite"),
    "normal count": (
        primitive("NORMAL", lambda b: b.accessor([[0, 0, 1]] * 2)),
        A + r"\.NORMAL: wrong count: wanted 3 like POSITION, got 2",
    ),
    "colour of bytes": (
        primitive("COLOR_0", lambda b: b.accessor([[0, 0, 1]] * 3, "u1")),
        A + r"\.COLOR_0: wrong accessor type: .* component type 5121, not normalized",
    ),
    "index beyond vertices": (
        primitive("indices", lambda b: b.accessor([0, 1, 3], "u2")),
        P + r"\.indices: element 2: index out of range: wanted 0 \.\. 2 \(vertices\), got 3",
    ),
    "indices are floats": (
        primitive("indices", lambda b: b.accessor([0, 1, 2])),
        P + r"\.indices: wrong accessor type: wanted SCALAR",
    ),
    "indices are negative": (
        primitive("indices", lambda b: b.accessor([0, -1, 2], "i2")),
        P + r"\.indices: wrong accessor type: wanted SCALAR",
    ),
    "four corners": (
        primitive("indices", lambda b: b.accessor([0, 1, 2, 0], "u2")),
        P + r"\.indices: wrong number of corners: wanted a multiple of 3, got 4",
    ),
    "strip of two": (
        lambda b: b.json["meshes"][0]["primitives"][0].update(
            mode=5, indices=b.accessor([0, 1], "u1")
        ),
        P + r"\.indices: wrong number of corners: wanted at least 3, got 2",
    ),
    "material out of range": (
        put("meshes.0.primitives.0.material", 5),
        P + r"\.material: index out of range: wanted 0 \.\. 0 \(materials\), got 5",
    ),
    "primitives is a number": (
        put("meshes.0.primitives", 1),
        r"meshes\[0\]\.primitives: wrong type",
    ),
    "primitive is null": (put("meshes.0.primitives.0", None), P + ": wrong type"),
    "no attributes": (put("meshes.0.primitives.0.attributes", ...), P + r"\.attributes: missing"),
    "attribute is a string": (primitive("POSITION", lambda b: "0"), A + r"\.POSITION: wrong type"),
    "mode is -1": (put("meshes.0.primitives.0.mode", -1), P + r"\.mode: unknown value"),
    "mode is text": (put("meshes.0.primitives.0.mode", "4"), P + r"\.mode: unknown value"),
    "mode is null": (put("meshes.0.primitives.0.mode", None), P + r"\.mode: wrong type"),
    "position -Inf": (floats(0, 2, -INF), A + r"\.POSITION: vertex 0: wanted finite"),
    "position 3e38": (floats(0, 0, 3e38), A + r"\.POSITION: vertex 0: wanted coordinates below"),
    "tangent NaN": (
        primitive("TANGENT", lambda b: b.accessor([[NAN, 0, 0, 1]] * 3)),
        A + r"\.TANGENT: vertex 0: wanted finite",
    ),
    "colour Inf": (
        primitive("COLOR_0", lambda b: b.accessor([[INF, 0, 0]] * 3)),
        A + r"\.COLOR_0: vertex 0: wanted finite",
    ),
    "uv of triples": (
        primitive("TEXCOORD_0", lambda b: b.accessor([[0, 0, 0]] * 3)),
        A + r"\.TEXCOORD_0: wrong accessor type: wanted VEC2",
    ),
    "uv too few": (
        primitive("TEXCOORD_0", lambda b: b.accessor([[0, 0]])),
        A + r"\.TEXCOORD_0: wrong count: wanted 3 like POSITION, got 1",
    ),
    "index 2^32 - 1": (indices(0, 1, 2**32 - 1), P + r"\.indices: element 2: index out of range"),
    "indices of pairs": (
        primitive("indices", lambda b: b.accessor([[0, 1]] * 3, "u2")),
        P + r"\.indices: wrong accessor type: wanted SCALAR",
    ),
    "indices out of range": (put("meshes.0.primitives.0.indices", 99), P + r"\.indices: index out"),
    "material is text": (put("meshes.0.primitives.0.material", "m"), P + r"\.material: wrong type"),
    "fan of one": (
        both(put("meshes.0.primitives.0.mode", 6), indices(0)),
        P + r"\.indices: wrong number of corners: wanted at least 3, got 1",
    ),
    "two corners": (indices(0, 1), P + r"\.indices: wrong number of corners: wanted a multiple"),
}

#: Shapes without an area, without a size or with too much of it: a picture, and no NaN in it.
ODD: dict[str, tuple[Change, str]] = {
    "one point": (corners(*[[0, 0, 0]] * 4), ""),
    "a line": (corners([0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]), ""),
    "a line that shines": (both(corners([0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]), shining), ""),
    "a point that shines": (both(corners(*[[0, 0, 0]] * 4), shining), ""),
    "doubled corners": (indices(0, 0, 1, 0, 1, 1), ""),
    "one bad triangle": (indices(0, 0, 0, 0, 1, 2, 0, 2, 3), ""),
    "one bad triangle that shines": (both(indices(0, 0, 0, 0, 1, 2, 0, 2, 3), shining), ""),
    "many bad triangles": (many_degenerate, ""),
    "needle": (corners([-2, 0, 0], [2, 0, 0], [2, 1e-7, 0], [-2, 1e-7, 0]), ""),
    "needle that shines": (
        both(corners([-2, 0, 0], [2, 0, 0], [2, 1e-20, 0], [-2, 1e-20, 0]), shining),
        "",
    ),
    "denormal": (times(1e-40), ""),
    "denormal that shines": (both(times(1e-40), shining), ""),
    "1e-20": (times(1e-20), ""),
    "1e-20 that shines": (both(times(1e-20), shining), ""),
    "1e-10 that shines": (both(times(1e-10), shining), ""),
    "1e10": (times(1e10), ""),
    "1e10 that shines": (both(times(1e10), shining), ""),
    "1e17": (times(4e17), ""),
    "1e17 that shines": (both(times(4e17), shining), ""),
    "negative zero": (floats(0, 2, -0.0), ""),
    "normals of 0": (both(*(floats(1, i, 0) for i in range(12))), ""),
    "normals denormal": (both(*(floats(1, i, 1e-42) for i in range(12))), ""),
    "normals huge": (both(*(floats(1, i, 3e38) for i in range(12))), ""),
    "normals backward": (both(*(floats(1, 3 * i + 2, -1) for i in range(4))), ""),
    "normals in the plane": (
        both(*(floats(1, 3 * i + k, v) for i in range(4) for k, v in ((0, 1), (2, 0)))),
        "",
    ),
    "tangents of 0": (both(*(floats(3, i, 0) for i in range(16))), ""),
    "tangents along normals": (
        both(*(floats(3, 4 * i + k, v) for i in range(4) for k, v in ((0, 0), (2, 1)))),
        "",
    ),
    "uv all equal": (both(*(floats(2, i, 0.5) for i in range(8)), alone("TANGENT")), ""),
    "uv of 1e30": (both(*(floats(2, i, 1e30) for i in range(8)), alone("TANGENT")), ""),
    "uv of 3e38": (both(*(floats(2, i, (-1) ** i * 3e38) for i in range(8))), ""),
    "uv denormal": (both(*(floats(2, i, 1e-42 * i) for i in range(8)), alone("TANGENT")), ""),
    "uv missing": (alone("TEXCOORD_0"), "lacks the texture coordinates"),
    "colours negative": (both(*(floats(4, i, -5) for i in range(16))), ""),
    "colours of 1e30": (both(*(floats(4, i, 1e30) for i in range(16))), ""),
    "no POSITION": (alone("POSITION"), "without POSITION is left out"),
    "points": (put("meshes.0.primitives.0.mode", 0), "primitive of points is left out"),
    "lines": (put("meshes.0.primitives.0.mode", 1), "primitive of lines is left out"),
    "no primitives at all": (put("meshes.0.primitives", []), ""),
    "unknown attribute": (primitive("_PRESSURE", lambda b: 0), ""),
    "same primitive 5000 times": (many_primitives, ""),
}
CASES: list[Case] = [*scenes("mesh", BAD, full), *drawn("shape", ODD, seen)]
