"""Mutants of stages: bytes, cuts, splices, tokens, and paths that lead out of their folder."""

from __future__ import annotations

import os
import re
import struct
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random

import numpy as np

from tests.fuzz import readers, stage_seeds
from tests.importers.usd.random_stages import write_stage

#: A file's name and bytes.
Seed = tuple[str, bytes]
_REST = """def Xform "Rest" (
    prepend payload = @beside.usda@</card>
    prepend inherits = </_class>
    variants = { string v = "b" }
    prepend variantSets = "v"
) {
    variantSet "v" = {
        "a" {
            def Cube "c" {
            }
        }
        "b" (specializes = </_class>) {
            def Sphere "s" {
                double radius = 2
            }
        }
    }
}
class "_class" {
    def Cone "tip" {
        double height = 1
    }
}
def Xform "clipped" (
    clips = { dictionary default = {
        string templateAssetPath = "./clip.#.usda"
        double templateStartTime = 1
        double templateEndTime = 3
        double templateStride = 1
        string primPath = "/card"
        asset manifestAssetPath = @beside.usda@
    } }
) {
}
def Xform "named" (references = @`"${FILE}.usda"`@</card>) {
}
def Xform "packed" (references = @package.usdz@) {
}
def Mesh "tiles" (prepend apiSchemas = ["MaterialBindingAPI"]) {
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    texCoord2f[] primvars:st = [(0, 0), (2, 0), (2, 1)] (interpolation = "vertex")
    rel material:binding = </mat>
}
def Material "mat" {
    token outputs:surface.connect = </mat/s.outputs:surface>
    def Shader "s" {
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </mat/t.outputs:rgb>
        float inputs:roughness.connect = </mat/p.outputs:r>
        token outputs:surface
    }
    def Shader "t" {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @tile.<UDIM>.png@
        float3 outputs:rgb
    }
    def Shader "p" {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @package.usdz[0/beside.png]@
        float outputs:r
    }
}
"""
_HEAD = """#usda 1.0
(
    subLayers = [@beside.usda@]
    expressionVariables = { string FILE = "beside" }
    metersPerUnit = 1
)
"""
#: Paths out of a folder, to devices, and to files that are none.
HOSTILE = (
    *("../outside/secret.usda", "../outside/secret.usdc", "../outside/secret.png", "/etc/passwd"),
    *(
        "/dev/zero",
        "/proc/self/environ",
        "link.usda",
        "link.png",
        "linked/secret.usda",
        "fifo.usda",
    ),
    *("../outside/pack.usdz[secret.usda]", "http://127.0.0.1/a.usda", "file:///etc/passwd"),
    *("../outside/secret.<UDIM>.png", "./../inside/../outside/secret.usda", "package.usdz[../a]"),
)


def write_folder(root: Path) -> Path:
    """Writes the files beside the stages, and others outside that none may open."""
    from tests.support.formats.make_gltf import png

    inside, outside = root / "inside", root / "outside"
    inside.mkdir(parents=True, exist_ok=True)
    outside.mkdir(exist_ok=True)
    list(stage_seeds.usdzs(inside))
    (inside / "package.usdz").write_bytes((inside / "usdc.usdz").read_bytes())
    pixels = png(np.full((4, 4, 3), 99, np.uint8))
    for name in ("tile.1001.png", "tile.1002.png"):
        (inside / name).write_bytes(pixels)
    for i in (1, 2, 3):
        (inside / f"clip.{i}.usda").write_bytes((inside / "clip.usda").read_bytes())
    for name in ("secret.usda", "secret.usdc"):
        (outside / name).write_bytes((inside / "beside.usda").read_bytes())
    for name in ("secret.png", "secret.1001.png"):
        (outside / name).write_bytes(pixels)
    (outside / "pack.usdz").write_bytes((inside / "usdc.usdz").read_bytes())
    for link, target in (("link.usda", "secret.usda"), ("link.png", "secret.png"), ("linked", "")):
        (inside / link).unlink(missing_ok=True)
        (inside / link).symlink_to(outside / target)
    if not (inside / "fifo.usda").exists():
        os.mkfifo(inside / "fifo.usda")
    return inside


def seeds(inside: Path) -> list[Seed]:
    """Good stages of all kinds, in the folder of ``write_folder``."""
    from pxr import Sdf

    found = [*stage_seeds.usdas(inside), *stage_seeds.usdcs(inside), *stage_seeds.usdzs(inside)]
    rest = inside / "rest.usda"
    rest.write_text(_HEAD + _REST)
    found.append(("rest.usda", rest.read_bytes()))
    layer = Sdf.Layer.FindOrOpen(str(rest))
    assert layer.Export(str(inside / "rest.usdc"))
    found.append(("rest.usdc", (inside / "rest.usdc").read_bytes()))
    for seed in range(6):
        write_stage(inside, seed)  # layers 1 and 2 stay beside the stage
        found.append(("random.usda", (inside / "0.usda").read_bytes()))
    return found


def mutant(rng: Random, goods: list[Seed]) -> Seed:
    """A stage that was changed, by one or two changes of any kind."""
    name, data = rng.choice(goods)
    for _ in range(rng.choice((1, 1, 1, 2))):
        change = rng.choice(_CHANGES)
        data = change(rng, name, data, goods)
    return name, data


def _by_format(rng: Random, name: str, data: bytes, goods: list[Seed]) -> bytes:
    try:
        return readers.changed(rng, name, data)
    except (ValueError, LookupError, struct.error, zlib.error):  # a change before broke its form
        return _flipped(rng, name, data, goods)


def _cut(rng: Random, name: str, data: bytes, goods: list[Seed]) -> bytes:
    return data[: rng.randrange(len(data) + 1)]


def _flipped(rng: Random, name: str, data: bytes, goods: list[Seed]) -> bytes:
    made = bytearray(data)
    for _ in range(rng.choice((1, 2, 8, 40)) if made else 0):
        made[rng.randrange(len(made))] ^= 1 << rng.randrange(8)
    return bytes(made)


def _spliced(rng: Random, name: str, data: bytes, goods: list[Seed]) -> bytes:
    suffix = Path(name).suffix
    other = rng.choice([one for kind, one in goods if Path(kind).suffix == suffix])
    at, into = rng.randrange(len(data) + 1), rng.randrange(len(other) + 1)
    return (
        data[:at]
        + other[into : into + rng.choice((40, 400, len(other)))]
        + data[at:][rng.choice((0, 40, 400)) :]
    )


def _swapped(rng: Random, name: str, data: bytes, goods: list[Seed]) -> bytes:
    """Two words change places; in binary files, over the shorter of them."""
    words = [one.span() for one in re.finditer(rb"[A-Za-z_:]{3,}", data)]
    if len(words) < 2:
        return data
    (a, b), (c, d) = sorted(rng.sample(words, 2))
    if Path(name).suffix == ".usda":
        return data[:a] + data[c:d] + data[b:c] + data[a:b] + data[d:]
    size = min(b - a, d - c)
    made = bytearray(data)
    made[a : a + size], made[c : c + size] = data[c : c + size], data[a : a + size]
    return bytes(made)


def _pointed(rng: Random, name: str, data: bytes, goods: list[Seed]) -> bytes:
    """A path of a file becomes another; in binary files, one of the same length."""
    path = rng.choice(HOSTILE).encode()
    if Path(name).suffix == ".usda":
        places = [one.span(1) for one in re.finditer(rb"@([^@\n]*)@|\"(\./[^\"]*)\"", data)]
    else:
        places = [one.span() for one in re.finditer(rb"[\w./]+\.(?:usd[acz]?|png)", data)]
    places = [one for one in places if one[0] >= 0]
    if not places:
        return data
    a, b = rng.choice(places)
    if Path(name).suffix != ".usda":
        path = (b"./" * (b - a) + path)[-(b - a) :] if len(path) < b - a else path[-(b - a) :]
    return data[:a] + path + data[b:]


def _numbered(rng: Random, name: str, data: bytes, goods: list[Seed]) -> bytes:
    """A number becomes one that breaks things; in binary files, four or eight bytes."""
    if Path(name).suffix != ".usda":
        made, size = bytearray(data), rng.choice((1, 4, 8))
        at = rng.randrange(max(len(data) - size, 1))
        made[at : at + size] = rng.choice(_BYTES)[:size]
        return bytes(made)
    places = [one.span() for one in re.finditer(rb"(?<![\w.])-?\d+(\.\d+)?", data[9:])]
    if not places:
        return data
    a, b = rng.choice(places)
    return data[: 9 + a] + rng.choice(_NUMBERS) + data[9 + b :]


def _lined(rng: Random, name: str, data: bytes, goods: list[Seed]) -> bytes:
    """A line goes, comes twice, or moves."""
    lines = data.split(b"\n")
    if Path(name).suffix != ".usda" or len(lines) < 4:
        return _flipped(rng, name, data, goods)
    at = rng.randrange(1, len(lines))
    line = lines.pop(at) if rng.random() < 0.7 else lines[at]
    if rng.random() < 0.7:
        lines.insert(rng.randrange(1, len(lines)), line)
    return b"\n".join(lines)


_NUMBERS = (b"0", b"-1", b"1e300", b"1e-300", b"nan", b"inf", b"-inf", b"2147483648", b"1000000")
_BYTES = (bytes(8), b"\xff" * 8, b"\x7f" * 8, b"\x00\x00\x80\x7f" * 2, b"\x01" + bytes(7))
_Change = Callable[[Random, str, bytes, list[Seed]], bytes]
_CHANGES: tuple[_Change, ...] = (
    *(_by_format, _by_format, _numbered, _numbered, _numbered, _lined, _lined, _lined, _swapped),
    *(_cut, _flipped, _spliced, _pointed, _pointed),
)


def mutants(goods: list[Seed], seed: int, count: int, first: int = 0) -> Iterator[Seed]:
    """Mutants, the same ones for the same seed."""
    for number in range(first, first + count):
        yield mutant(Random(f"{seed} {number}"), goods)
