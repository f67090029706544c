"""Lens files (--lens)."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from daguerre import lenses

from .bases import ENDLESS, beside_scene
from .case import DRAW, Case, keys_of

COMMAND = ("render", "{folder}/scene.glb", "--lens", "{bad}", *DRAW, "--sky", "1,1,1")
GOOD = json.loads((Path(lenses.__file__).parent / "library" / "tessar-50mm-f2.8.json").read_text())


def change(path: str, value: Any) -> Any:
    """The Tessar with one value set; ``...`` removes it."""
    lens = copy.deepcopy(GOOD)
    *keys, last = keys_of(path)
    target: Any = lens
    for key in keys:
        target = target[key]
    if value is ...:
        del target[last]
    else:
        target[last] = value
    return lens


def surfaces(count: int) -> Any:
    """A lens of very many planes."""
    plane = {"kind": "spherical", "radius": None, "thickness": 1, "semi_diameter": 5}
    return {**GOOD, "surfaces": [GOOD["surfaces"][4], *[plane] * count]}


S = r"surfaces\[0\]\."
LENSES: dict[str, tuple[Any, str]] = {
    "a list": ([], "wrong type: wanted an object"),
    "no schema": (change("schema", ...), "schema: missing"),
    "another schema": (change("schema", "lens/9"), "schema: wanted 'daguerre-lens/0.1'"),
    "schema is 1": (change("schema", 1), "schema: wrong type"),
    "no surfaces": (change("surfaces", ...), "surfaces: missing"),
    "surfaces is an object": (change("surfaces", {}), "surfaces: wrong type"),
    "empty surfaces": (change("surfaces", []), "surfaces: the list is empty"),
    "surface is null": (change("surfaces.0", None), r"surfaces\[0\]: wrong type"),
    "no kind": (change("surfaces.0.kind", ...), S + "kind: missing"),
    "kind is 3": (change("surfaces.0.kind", 3), S + "kind: wrong type"),
    "kind is a mirror": (change("surfaces.0.kind", "mirror"), S + "kind: unknown value"),
    "asphere is a list": (change("surfaces.0.asphere", [1e-6]), S + "asphere: wrong type"),
    "asphere of power 0": (change("surfaces.0.asphere", {"a0": 1}), S + r"asphere\.a0: wanted a"),
    "asphere of power 1e9": (
        change("surfaces.0.asphere", {"a1000000000": 1}),
        S + r"asphere\.a1000000000: wanted a power",
    ),
    "asphere is text": (change("surfaces.0.asphere", {"a4": "x"}), S + r"asphere\.a4: wrong type"),
    "conic is text": (change("surfaces.0.conic", "k"), S + "conic: wrong type"),
    "tilt of two": (change("surfaces.0.tilt", [1, 2]), S + "tilt: wrong length"),
    "tilt of a turn": (change("surfaces.0.tilt", [360, 0, 0]), S + r"tilt\[0\]: out of range"),
    "coating of paint": (change("surfaces.0.coating", "paint"), S + "coating: unknown value"),
    "obstruction too wide": (
        change("surfaces.0.inner_semi_diameter", 50),
        S + "inner_semi_diameter: wanted 0 mm",
    ),
    "narrower than the source": (
        change("surfaces.0.widened_from", 50),
        S + "widened_from: wanted less than the semi-diameter, got 50",
    ),
    "mount of glass": (
        change("surfaces.0.fitted", True),
        S + "fitted: wanted a plane in air with a semi_diameter",
    ),
    "groups is an object": (change("groups", {}), "groups: wrong type"),
    "group beyond the table": (
        change("groups", [{"surfaces": [0, 99]}]),
        r"groups\[0\]\.surfaces\[1\]: out of range",
    ),
    "group backwards": (
        change("groups", [{"surfaces": [3, 1]}]),
        r"groups\[0\]\.surfaces: wanted \[first, last\]",
    ),
    "radius 0": (change("surfaces.0.radius", 0), S + "radius: wanted a signed radius"),
    "radius is text": (change("surfaces.0.radius", "20"), S + "radius: wrong type"),
    "radius 1e-300": (change("surfaces.0.radius", 1e-300), "surface|radius"),
    "thickness negative": (change("surfaces.0.thickness", -1), S + "thickness: wanted at least 0"),
    "thickness null": (change("surfaces.0.thickness", None), S + "thickness: wanted the distance"),
    "thickness 1e300": (change("surfaces.0.thickness", 1e300), "thickness"),
    "semi-diameter 0": (change("surfaces.0.semi_diameter", 0), S + "semi_diameter: out of range"),
    "semi-diameter beyond": (
        change("surfaces.0.semi_diameter", 100),
        S + "semi_diameter: wanted at most the radius",
    ),
    "no stop": (change("surfaces.4.kind", "spherical"), "surfaces: wanted exactly one stop, got 0"),
    "two stops": (change("surfaces.0.stop", True), "surfaces: wanted exactly one stop, got 2"),
    "stop is 1": (change("surfaces.0.stop", 1), S + "stop: wrong type"),
    "nd 0": (change("surfaces.0.glass.nd", 0), S + r"glass\.nd: out of range"),
    "nd 1e300": (change("surfaces.0.glass.nd", 1e300), S + r"glass\.nd: not finite"),
    "nd is text": (change("surfaces.0.glass.nd", "BK7"), S + r"glass\.nd: wrong type"),
    "vd 0": (change("surfaces.0.glass.vd", 0), S + r"glass\.vd: out of range"),
    "vd 1": (change("surfaces.0.glass.vd", 1), S + r"glass\.vd: wanted an Abbe number"),
    "glass is a string": (change("surfaces.0.glass", "BK7"), S + "glass: wrong type"),
    "glass table empty": (change("surfaces.0.glass", {"table": []}), S + r"glass\.table: wanted"),
    "glass table of one": (
        change("surfaces.0.glass", {"table": [[500]]}),
        S + r"glass\.table\[0\]: wrong length",
    ),
    "glass table doubled": (
        change("surfaces.0.glass", {"table": [[500, 1.5], [500, 1.6]]}),
        S + r"glass\.table: wavelengths must differ, got two indices",
    ),
    "glass table of 0": (
        change("surfaces.0.glass", {"table": [[500, 0], [600, 1]]}),
        S + r"glass\.table\[\d\].*: out of range",
    ),
    "coating": (change("coating", "magic"), "coating: unknown value"),
    "object medium": (change("object_medium", 5), "object_medium: wrong type"),
    "nominal is text": (change("nominal", "50mm"), "nominal: wrong type"),
    "efl negative": (change("configurations.0.efl_mm", -50), r"efl_mm: out of range"),
    "gaps of nowhere": (change("configurations.0.gaps", {"99": 1}), r"gaps\.99: wanted the index"),
    "gap is text": (change("configurations.0.gaps", {"0": "1"}), r"gaps\.0: wrong type"),
    "gap negative": (change("configurations.0.gaps", {"0": -1}), "thickness|gaps"),
    "gaps is a list": (change("configurations.0.gaps", []), r"gaps: wrong type"),
    "configurations is text": (change("configurations", "wide"), "configurations: wrong type"),
    "1001 surfaces": (surfaces(1001), "surfaces"),
    "plane glass": (surfaces(3), "."),
    "afocal": (
        {**GOOD, "surfaces": [{**s, "radius": None} for s in GOOD["surfaces"]]},
        ".",
    ),
}
TEXTS: dict[str, tuple[str, bytes, str]] = {
    "empty": ("lens.json", b"", "JSON: empty file"),
    "text": ("lens.json", b"hello", "JSON: line 1, column 1"),
    "not utf-8": ("lens.json", b'{"a":"\xff"}', "JSON: wanted UTF-8, got byte 0xff"),
    "nan": (
        "lens.json",
        b'{"schema": NaN}',
        "JSON: line 1, column 12: wanted a finite",
    ),
    "deep": ("lens.json", b"[" * 200_000, "nested too deeply"),
    "long integer": ("lens.json", b'{"schema": ' + b"9" * 9000 + b"}", "JSON"),
    "doubled": ("lens.json", b'{"schema": 1, "schema": 2}', "schema: .*twice"),
    "huge float": ("lens.json", b'{"schema": 1e999}', "wanted|JSON"),
    "of 20 MB": ("lens.json", b" " * 20_000_000, "wanted at most 16000000 bytes, got 20000000"),
    "no lens": ("lens.lens", b"SURF 0", r"lens file: wanted \.json, .*got \.lens"),
}


def _make(name: str, data: bytes) -> Callable[[Path], Path]:
    return beside_scene(name, lambda path: path.write_bytes(data))


CASES = [
    *(
        Case(f"lens-{key}", _make("lens.json", json.dumps(lens).encode()), error, command=COMMAND)
        for key, (lens, error) in LENSES.items()
    ),
    *(
        Case(f"lens-{key}", _make(name, data), error, command=COMMAND)
        for key, (name, data, error) in TEXTS.items()
    ),
    *(
        Case(f"lens-{key}", beside_scene("lens.json", put), "not a regular file", command=COMMAND)
        for key, put in ENDLESS.items()
    ),
]
