"""Bad glTF: every file ends soon in one InputError that names file, place, wanted and got."""

from __future__ import annotations

import base64
import json
import os
import struct
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from daguerre.errors import InputError
from daguerre.io import gltf

from .make_gltf import CORNERS, Builder, chunk, glb_bytes, jpeg, png, triangle

PIXELS = np.full((8, 8, 3), 128, np.uint8)


def full() -> Builder:
    """A bit of everything: what the cases below damage."""
    b = triangle()
    primitive = b.json["meshes"][0]["primitives"][0]
    primitive["attributes"]["NORMAL"] = b.accessor([[0, 0, 1]] * 3)
    primitive["attributes"]["TEXCOORD_0"] = b.accessor([[0, 0], [1, 0], [0, 1]])
    primitive["material"] = 0
    b.image(png(PIXELS))
    b.add("samplers", {})
    b.json["textures"][0]["sampler"] = 0
    info = {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [1, 1]}}}
    b.add(
        "materials",
        {
            "pbrMetallicRoughness": {"baseColorTexture": info, "baseColorFactor": [1, 1, 1, 1]},
            "extensions": {"KHR_materials_ior": {"ior": 1.5}},
        },
    )
    b.add("cameras", {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}})
    b.json["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}}
    leaf = b.child(name="leaf")
    b.node(camera=0, extensions={"KHR_lights_punctual": {"light": 0}}, children=[leaf])
    sampler = {"input": b.accessor([0, 1]), "output": b.accessor([[0, 0, 0, 1]] * 2)}
    channel = {"sampler": 0, "target": {"node": leaf, "path": "rotation"}}
    b.add("animations", {"samplers": [sampler], "channels": [channel]})
    return b


def put(path: str, value: Any) -> Callable[[Builder], None]:
    """Sets the JSON value at a path such as ``meshes.0.primitives.0.mode``; ``...`` removes it."""

    def change(b: Builder) -> None:
        b.json["buffers"] = [{"byteLength": len(b.binary)}]
        *keys, last = [int(k) if k.isdigit() else k for k in path.split(".")]
        target: Any = b.json
        for key in keys:
            target = target[key]
        if value is ...:
            del target[last]
        else:
            target[last] = value

    return change


def floats(accessor: int, offset: int, value: float) -> Callable[[Builder], None]:
    """Overwrites one float of an accessor's bytes."""

    def change(b: Builder) -> None:
        view = b.json["bufferViews"][b.json["accessors"][accessor]["bufferView"]]
        struct.pack_into("<f", b.binary, view["byteOffset"] + 4 * offset, value)

    return change


def ring(b: Builder) -> None:
    b.json["nodes"] += [{"children": [4]}, {"children": [3]}]


def stride(b: Builder) -> None:
    b.json["bufferViews"][b.json["accessors"][0]["bufferView"]]["byteStride"] = 8


def sparse(**change: Any) -> Callable[[Builder], None]:
    def apply(b: Builder) -> None:
        places = change.pop("places", [0, 2])
        b.json["accessors"][0]["sparse"] = {
            "count": 2,
            "indices": {"bufferView": b.view(bytes(places)), "componentType": 5121},
            "values": {"bufferView": b.view(struct.pack("<6f", *range(6)))},
        } | change

    return apply


def primitive(key: str, make: Callable[[Builder], Any]) -> Callable[[Builder], None]:
    def change(b: Builder) -> None:
        target = b.json["meshes"][0]["primitives"][0]
        if key.isupper() or key.endswith(("_0", "_1")):
            target = target["attributes"]
        target[key] = make(b)

    return change


P = r"meshes\[0\]\.primitives\[0\]"
A = P + r"\.attributes"
BIG = 2**40
CASES: dict[str, tuple[Callable[[Builder], None], str]] = {
    # Structure and types
    "no asset": (put("asset", ...), r"asset: missing: wanted a value, got none"),
    "version 1": (put("asset.version", "1.0"), r"asset\.version: unsupported: wanted glTF 2\.0"),
    "version is a number": (put("asset.version", 2.0), r"asset\.version: wrong type: wanted a str"),
    "min version": (put("asset.minVersion", "2.1"), r"asset\.minVersion: unsupported"),
    "version is text": (put("asset.version", "two"), r"asset\.version: wanted a version such as"),
    "nodes is an object": (put("nodes", {}), r"nodes: wrong type: wanted a list, got an object"),
    "node is a number": (put("nodes.1", 7), r"nodes\[1\]: wrong type: wanted an object, got 7"),
    "name is a list": (put("nodes.0.name", []), r"nodes\[0\]\.name: wrong type: wanted a string"),
    "mesh is a string": (put("nodes.0.mesh", "0"), r"nodes\[0\]\.mesh: wrong type: wanted an int"),
    "mesh is true": (put("nodes.0.mesh", True), r"nodes\[0\]\.mesh: wrong type: .* got True"),
    "mesh is 0.5": (put("nodes.0.mesh", 0.5), r"nodes\[0\]\.mesh: wrong type: .* got 0\.5"),
    "mesh is null": (put("nodes.0.mesh", None), r"nodes\[0\]\.mesh: wrong type: .* got None"),
    "mesh out of range": (
        put("nodes.0.mesh", 1),
        r"nodes\[0\]\.mesh: index out of range: wanted 0 \.\. 0 \(meshes\), got 1",
    ),
    "mesh is negative": (put("nodes.0.mesh", -1), r"nodes\[0\]\.mesh: index out of range: .* -1"),
    "mesh is huge": (put("nodes.0.mesh", 10**30), r"nodes\[0\]\.mesh: index out of range"),
    "camera out of range": (put("nodes.2.camera", 4), r"nodes\[2\]\.camera: index out of range"),
    "skin without skins": (put("nodes.0.skin", 0), r"skin: index out of range: wanted none"),
    "scene out of range": (put("scene", 3), r"scene: index out of range: wanted 0 \.\. 0"),
    "scene node out of range": (put("scenes.0.nodes", [9]), r"scenes\[0\]\.nodes\[0\]: index out"),
    "scene node twice": (put("scenes.0.nodes", [0, 0]), r"nodes\[1\]: wanted each node once"),
    "scene node is a child": (
        put("scenes.0.nodes", [1]),
        r"scenes\[0\]\.nodes\[0\]: wanted a root node, got node 1, a child of node 2",
    ),
    "child out of range": (put("nodes.2.children", [1, 8]), r"nodes\[2\]\.children\[1\]: index"),
    "two parents": (
        put("nodes.0.children", [1]),
        r"nodes\[2\]\.children\[0\]: wanted a tree of nodes, got node 1 .* child of node 0",
    ),
    "own child": (put("nodes.1.children", [1]), r"nodes\[1\]\.children\[0\]: wanted a tree"),
    "ring": (ring, r"nodes\[3\]: wanted a tree of nodes, got a node that is its own ancestor"),
    "huge float": (put("nodes.0.translation", [1e999, 0, 0]), r"JSON: line 1, column \d+: wanted"),
    "huge integer": (
        put("nodes.0.translation", [10**400, 0, 0]),
        r"nodes\[0\]\.translation\[0\]: not finite",
    ),
    "overflow": (
        put("nodes.0.matrix", [*[1e308, 1e308, 0, 0] * 3, 1e308, 1e308, 0, 1]),
        r"nodes\[0\]: world transform: wanted numbers below 1e\+18, got 1e\+308",
    ),
    "translation too short": (
        put("nodes.0.translation", [1, 2]),
        r"nodes\[0\]\.translation: wrong length: wanted 3 numbers, got 2",
    ),
    "translation of strings": (
        put("nodes.0.translation", ["1", 2, 3]),
        r"nodes\[0\]\.translation\[0\]: wrong type: wanted a number, got '1'",
    ),
    "rotation of length 0": (
        put("nodes.0.rotation", [0, 0, 0, 0]),
        r"nodes\[0\]\.rotation: wanted a quaternion of length 1, got length 0",
    ),
    "matrix too short": (put("nodes.0.matrix", [1] * 15), r"matrix: wrong length: wanted 16"),
    "projective matrix": (put("nodes.0.matrix", [1] * 16), r"matrix: wanted 0, 0, 0, 1 as its la"),
    "animated matrix": (
        put("nodes.1.matrix", np.eye(4).ravel().tolist()),
        r"nodes\[1\]\.matrix: wanted either a matrix or",
    ),
    "long string": (put("asset.version", "x" * 10**6), r"'x{40}'\.\.\. \(1000000 long\)"),
    # Bytes
    "buffer is longer": (
        put("buffers", [{"byteLength": 10**6}]),
        r"buffers\[0\]\.byteLength: the binary chunk is too short: wanted 1000000 bytes, got",
    ),
    "buffer length negative": (put("buffers", [{"byteLength": -4}]), r"byteLength: out of range"),
    "buffer without uri": (
        put("buffers", [{"byteLength": 4}, {"byteLength": 4}]),
        r"buffers\[1\]\.uri: missing",
    ),
    "view beyond buffer": (
        put("bufferViews.0.byteLength", 10**9),
        r"bufferViews\[0\]: beyond its buffer \(\d+ bytes\): wanted .* got 0 \+ 1000000000",
    ),
    "view offset negative": (put("bufferViews.0.byteOffset", -4), r"byteOffset: out of range"),
    "view offset huge": (put("bufferViews.0.byteOffset", BIG), r"bufferViews\[0\]: beyond its bu"),
    "view without buffer": (put("bufferViews.0.buffer", 1), r"\.buffer: index out of range"),
    "stride 0": (
        put("bufferViews.0.byteStride", 0),
        r"byteStride: out of range: wanted 1 \.\. 252",
    ),
    "stride too small": (
        stride,
        r"bufferViews\[\d\]\.byteStride: too small for accessors\[0\]: wan",
    ),
    "accessor beyond view": (
        put("accessors.0.count", 4),
        r"accessors\[0\]: beyond its bufferView \(bufferViews\[0\]\): wanted at most 36 bytes, g",
    ),
    "accessor of 2^40": (put("accessors.0.count", BIG), r"accessors\[0\]: beyond its bufferView"),
    "accessor of 10^40": (put("accessors.0.count", 10**40), r"accessors\[0\]: beyond its buffer"),
    "accessor of -1": (put("accessors.0.count", -1), r"accessors\[0\]\.count: out of range"),
    "accessor of 0": (put("accessors.0.count", 0), r"count: out of range: wanted at least 1"),
    "accessor offset": (put("accessors.0.byteOffset", 10**30), r"accessors\[0\]: beyond its buff"),
    "zeros of 2^40": (
        lambda b: (
            b.json["accessors"][0].update(count=BIG) or b.json["accessors"][0].pop("bufferView")
        ),
        r"accessors\[0\]\.count: too large without a bufferView",
    ),
    "accessor view out of range": (put("accessors.0.bufferView", 99), r"bufferView: index out of"),
    "component type": (
        put("accessors.0.componentType", 5124),
        r"componentType: unknown value: wan",
    ),
    "accessor type": (put("accessors.0.type", "VEC5"), r"accessors\[0\]\.type: unknown value: wan"),
    "no type": (put("accessors.0.type", ...), r"accessors\[0\]\.type: missing"),
    "normalized is 1": (
        put("accessors.0.normalized", 1),
        r"normalized: wrong type: wanted true or",
    ),
    "sparse out of range": (
        sparse(places=[0, 3]),
        r"sparse\.indices: index out of range: wanted 0",
    ),
    "sparse falls": (sparse(places=[2, 0]), r"sparse\.indices: wanted indices that rise strictly"),
    "sparse count": (sparse(count=4), r"sparse\.count: out of range: wanted 1 \.\. 3, got 4"),
    "sparse too short": (sparse(count=3), r"sparse\.indices: beyond its bufferView"),
    # Meshes
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
    # Materials and textures
    "base colour": (
        put("materials.0.pbrMetallicRoughness.baseColorFactor", [1, 1, 1]),
        r"baseColorFactor: wrong length: wanted 4 numbers, got 3",
    ),
    "negative colour": (
        put("materials.0.pbrMetallicRoughness.baseColorFactor", [1, -1, 1, 1]),
        r"baseColorFactor\[1\]: out of range: wanted 0 \.\. 1",
    ),
    "roughness": (
        put("materials.0.pbrMetallicRoughness.roughnessFactor", 2),
        r"materials\[0\]\.pbrMetallicRoughness\.roughnessFactor: out of range",
    ),
    "alpha mode": (put("materials.0.alphaMode", "FADE"), r"alphaMode: unknown value: .* 'FADE'"),
    "double sided": (put("materials.0.doubleSided", 1), r"doubleSided: wrong type"),
    "ior": (
        put("materials.0.extensions.KHR_materials_ior.ior", 0.5),
        r"materials\[0\]\.extensions\.KHR_materials_ior\.ior: out of range: wanted 0 or at least 1",
    ),
    "dispersion": (
        put("materials.0.extensions.KHR_materials_dispersion", {"dispersion": -0.1}),
        r"extensions\.KHR_materials_dispersion\.dispersion: out of range: wanted at least 0",
    ),
    "dispersion is text": (
        put("materials.0.extensions.KHR_materials_dispersion", {"dispersion": "1"}),
        r"materials\[0\]\.extensions\.KHR_materials_dispersion\.dispersion: wrong type",
    ),
    "extension is a list": (put("materials.0.extensions", []), r"extensions: wrong type"),
    "emission": (put("materials.0.emissiveFactor", [-1, 0, 0]), r"emissiveFactor\[0\]: out of ran"),
    "attenuation": (
        put("materials.0.extensions.KHR_materials_volume", {"attenuationDistance": 0}),
        r"attenuationDistance: out of range: wanted a number above 0",
    ),
    "texture out of range": (
        put("materials.0.normalTexture", {"index": 1}),
        r"materials\[0\]\.normalTexture\.index: index out of range: wanted 0 \.\. 0 \(textures\)",
    ),
    "texture without index": (put("materials.0.normalTexture", {}), r"index: missing"),
    "texture set": (put("materials.0.normalTexture", {"index": 0, "texCoord": -1}), r"texCoord: "),
    "texture scale": (
        put(
            "materials.0.pbrMetallicRoughness.baseColorTexture.extensions.KHR_texture_transform",
            {"scale": 2},
        ),
        r"KHR_texture_transform\.scale: wrong type: wanted a list of 2 numbers, got 2",
    ),
    "image out of range": (put("textures.0.source", 7), r"textures\[0\]\.source: index out of"),
    "sampler out of range": (put("textures.0.sampler", 7), r"textures\[0\]\.sampler: index out"),
    "wrap": (put("samplers.0.wrapS", 5), r"samplers\[0\]\.wrapS: unknown value"),
    "filter": (put("samplers.0.minFilter", 5), r"samplers\[0\]\.minFilter: unknown value"),
    "image from nowhere": (put("images.0", {}), r"images\[0\]: wanted either a uri or a bufferVi"),
    "image view": (put("images.0.bufferView", 77), r"images\[0\]\.bufferView: index out of range"),
    "image missing": (
        put("images.0", {"uri": "wood.png", "name": "wood"}),
        r"images\[0\]\.uri: missing file: wanted '.*wood\.png', got no such file",
    ),
    "image is text": (
        put("images.0", {"uri": "data:image/png;base64,aGVsbG8=", "name": "wood"}),
        r"images\[0\] \('wood'\): wanted a PNG, JPEG, WebP or KTX2 image, got b'hello'",
    ),
    "data without comma": (
        put("images.0", {"uri": "data:x"}),
        r"images\[0\]\.uri: broken data URI",
    ),
    "data not base64": (
        put("images.0", {"uri": "data:image/png;base64,!!"}),
        r"images\[0\]\.uri: broken data URI",
    ),
    # Cameras and lights
    "camera type": (put("cameras.0.type", "fisheye"), r"cameras\[0\]\.type: unknown value"),
    "no perspective": (put("cameras.0.perspective", ...), r"cameras\[0\]\.perspective: missing"),
    "yfov 0": (put("cameras.0.perspective.yfov", 0), r"yfov: out of range: wanted a number above"),
    "yfov 4": (put("cameras.0.perspective.yfov", 4), r"yfov: out of range: wanted less than pi"),
    "aspect": (put("cameras.0.perspective.aspectRatio", -1), r"aspectRatio: out of range"),
    "f-stop 0": (
        put("cameras.0.extras", {"daguerre": {"fStop": 0}}),
        r"cameras\[0\]\.extras\.daguerre\.fStop: out of range: .* \(a pinhole is",
    ),
    "focus": (
        put("cameras.0.extensions", {"EXT_camera_physical": {"focusDistance": "far"}}),
        r"EXT_camera_physical\.focusDistance: wrong type: wanted a number, got 'far'",
    ),
    "sensor": (
        put("cameras.0.extensions", {"EXT_camera_physical": {"sensorSize": [36, 0]}}),
        r"sensorSize: out of range",
    ),
    "lens is a path": (
        put("cameras.0.extras", {"daguerre": {"lens": "../secret.json"}}),
        r"daguerre\.lens: refused",
    ),
    "camera scaled to nothing": (
        put("nodes.2.scale", [0, 0, 0]),
        r"nodes\[2\]: wanted a transform",
    ),
    "light out of range": (
        put("nodes.2.extensions.KHR_lights_punctual.light", 1),
        r"nodes\[2\]\.extensions\.KHR_lights_punctual\.light: index out of range",
    ),
    "light type": (put("extensions.KHR_lights_punctual.lights.0.type", "sun"), r"type: unknown va"),
    "light intensity": (
        put("extensions.KHR_lights_punctual.lights.0.intensity", -3),
        r"extensions\.KHR_lights_punctual\.lights\[0\]\.intensity: out of range",
    ),
    "cone": (
        put("extensions.KHR_lights_punctual.lights.0.spot", {"innerConeAngle": 1}),
        r"spot: wanted innerConeAngle below outerConeAngle, got 1 and 0\.785",
    ),
    # Animation
    "target node": (put("animations.0.channels.0.target.node", 50), r"target\.node: index out of"),
    "channel sampler": (put("animations.0.channels.0.sampler", 1), r"sampler: index out of range"),
    "interpolation": (put("animations.0.samplers.0.interpolation", "SINE"), r"interpolation: unkn"),
    "keys": (
        lambda b: floats(b.json["animations"][0]["samplers"][0]["input"], 1, -1.0)(b),
        r"samplers\[0\]\.input: key time 1: wanted times that rise strictly, got 0 then -1",
    ),
    "key NaN": (
        lambda b: floats(b.json["animations"][0]["samplers"][0]["input"], 0, float("nan"))(b),
        r"samplers\[0\]\.input: key time 0: wanted finite",
    ),
    "key values": (
        lambda b: b.json["animations"][0]["samplers"][0].update(interpolation="CUBICSPLINE"),
        r"output: wrong number of key values: wanted 6 \(CUBICSPLINE\), got 2",
    ),
    "key value of length 0": (
        lambda b: floats(b.json["animations"][0]["samplers"][0]["output"], 3, 0.0)(b),
        r"samplers\[0\]\.output: key value 0: wanted a quaternion of length 1",
    ),
    "key value type": (
        put("animations.0.channels.0.target.path", "scale"),
        r"output: wrong accessor type: wanted VEC3, got VEC4",
    ),
    # Extensions
    "required and unknown": (
        put("extensionsRequired", ["EXT_texture_avif"]),
        r"extensionsRequired\[0\]: unknown extension: .*got 'EXT_texture_avif'",
    ),
    "required is text": (put("extensionsRequired", "KHR_x"), r"extensionsRequired: wrong type"),
    "used holds a number": (put("extensionsUsed", [3]), r"extensionsUsed\[0\]: wrong type"),
}


def test_the_undamaged_file_is_read(tmp_path):
    scene = gltf.read(full().glb(tmp_path / "a.glb"))
    assert scene.warnings == []
    assert len(scene.textures) == len(scene.cameras) == len(scene.lights) == 1


@pytest.mark.parametrize("case", CASES)
def test_bad_document(tmp_path, case):
    change, wanted = CASES[case]
    b = full()
    change(b)
    path = b.glb(tmp_path / "bad.glb")
    start = time.perf_counter()
    with pytest.raises(InputError, match=wanted) as caught:
        gltf.read(path)
    assert time.perf_counter() - start < 5
    assert str(caught.value).startswith(f"{path}: ")
    assert len(str(caught.value)) < 800
    assert "\n" not in str(caught.value)


GOOD = b'{"asset":{"version":"2.0"}}'


def header(magic=b"glTF", version=2, length=None, size=28, kind=b"JSON", rest=GOOD + b" "):
    body = struct.pack("<I4s", size, kind) + rest
    return struct.pack("<4sII", magic, version, 12 + len(body) if length is None else length) + body


FILES: dict[str, tuple[bytes, str]] = {
    "empty": (b"", r"header\.magic: wanted b'glTF', got b''"),
    "magic": (header(magic=b"glTf"), r"header\.magic: wanted b'glTF', got b'glTf'"),
    "json in a glb": (GOOD, r"header\.magic: wanted b'glTF', got b'{\"as'"),
    "five bytes": (b"glTF\2", r"header: truncated: wanted at least 20 bytes, got 5"),
    "version": (header(version=1), r"header\.version: wanted 2, got 1"),
    "length too long": (
        header(length=1000),
        r"header\.length: truncated: wanted 1000 bytes, got 48",
    ),
    "length too short": (header(length=12), r"header\.length: wanted at least 20"),
    "chunk too long": (header(size=29), r"chunk 0\.length: wanted at most 28 bytes left, got 29"),
    "chunk of 4 GiB": (header(size=2**32 - 1), r"chunk 0\.length: wanted at most 28 bytes left"),
    "chunk type": (header(kind=b"BIN\0"), r"chunk 0\.type: wanted 0x4e4f534a \(JSON\)"),
    "half a header": (
        header(rest=GOOD + b" ABCD"),
        r"chunk 1: truncated: wanted 8 bytes of header",
    ),
    "cut off": (header()[:-9], r"header\.length: truncated: wanted 48 bytes, got 39"),
    "no json": (glb_bytes(b""), r"JSON: line 1, column 1: Expecting value"),
    "comma": (
        glb_bytes(b'{"asset":\n  {"version":"2.0",}}'),
        r"JSON: line 2, column \d+: ",
    ),
    "nan": (
        glb_bytes(b'{"asset":{"version":"2.0"},\n "x": "NaN", "y": NaN}'),
        r"JSON: line 2, column 19: wanted a finite number, got NaN",
    ),
    "infinity": (
        glb_bytes(b'{"a":-Infinity}'),
        r"JSON: line 1, column 6: wanted a finite number, got -Infinity",
    ),
    "not utf-8": (glb_bytes(b'{"a":"\xff"}'), r"JSON: wanted UTF-8, got byte 0xff at byte 6"),
    "deep json": (glb_bytes(b"[" * 200_000), r"JSON: nested too deeply"),
    "long integer": (glb_bytes(b'{"a":' + b"9" * 9000 + b"}"), r"JSON: Exceeds the limit"),
    "a list": (glb_bytes(b"[1, 2]"), r"wrong type: wanted an object, got \[1, 2\]"),
    "a string": (glb_bytes(b'"scene"'), r"wrong type: wanted an object, got 'scene'"),
}


@pytest.mark.parametrize("case", FILES)
def test_bad_container(tmp_path, case):
    data, wanted = FILES[case]
    path = tmp_path / "bad.glb"
    path.write_bytes(data)
    with pytest.raises(InputError, match=wanted) as caught:
        gltf.read(path)
    assert str(caught.value).startswith(f"{path}: ")


@pytest.mark.parametrize("keep", np.linspace(0, 0.999, 25))
def test_truncated_anywhere(tmp_path, keep):
    path = full().glb(tmp_path / "a.glb")
    path.write_bytes(path.read_bytes()[: int(keep * path.stat().st_size)])
    with pytest.raises(InputError, match=r"a\.glb: header"):
        gltf.read(path)


def moving() -> Builder:
    """Morph targets, a skin, instances, visibility and pointers."""
    b = triangle()
    primitive = b.json["meshes"][0]["primitives"][0]
    primitive["attributes"] |= {
        "NORMAL": b.accessor([[0, 0, 1]] * 3),
        "JOINTS_0": b.accessor([[0, 1, 0, 0]] * 3, "u1"),
        "WEIGHTS_0": b.accessor([[0.5, 0.5, 0, 0]] * 3),
    }
    sparse = {
        "count": 1,
        "indices": {"bufferView": b.view(b"\2"), "componentType": 5121},
        "values": {"bufferView": b.view(struct.pack("<3f", 0, 0, 6))},
    }
    empty = {"componentType": 5126, "count": 3, "type": "VEC3"}
    lift = b.add("accessors", empty | {"sparse": sparse})
    primitive["targets"] = [{"POSITION": lift}, {"NORMAL": b.accessor([[1, 0, 0]] * 3)}]
    b.json["meshes"][0]["weights"] = [1, 0.5]
    bind = np.tile(np.eye(4).ravel(), (2, 1))
    b.add("skins", {"joints": [1, 2], "inverseBindMatrices": b.accessor(bind)})
    b.json["nodes"][0]["skin"] = 0
    b.node(children=[2], extensions={"KHR_node_visibility": {"visible": True}})
    columns = {"ROTATION": b.accessor([[0, 0, 0, 1]] * 2), "_ID": b.accessor([1, 2])}
    b.child(mesh=0, extensions={"EXT_mesh_gpu_instancing": {"attributes": columns}})
    keys = b.accessor([0])
    for pointer, output in (
        ("/nodes/1/rotation", b.accessor([[0, 0, 0, 1]])),
        ("/nodes/0/weights/1", b.accessor([0.25])),
        ("/nodes/1/extensions/KHR_node_visibility/visible", b.accessor([1], "u1")),
    ):
        target = {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}
        sampler = {"input": keys, "output": output, "interpolation": "STEP"}
        b.add(
            "animations",
            {"samplers": [sampler], "channels": [{"sampler": 0, "target": target}]},
        )
    return b


@pytest.mark.parametrize("make", [full, moving])
def test_random_damage_never_escapes(tmp_path, make):
    """Whatever the bytes: a scene or an InputError, nothing else."""
    good = make().glb(tmp_path / "a.glb").read_bytes()
    rng = np.random.default_rng(7)
    outcomes = {True: 0, False: 0}
    for _ in range(800):
        data = bytearray(good)
        for place in rng.integers(12, len(data), rng.integers(1, 5)):
            data[place] = rng.integers(256)
        (tmp_path / "b.glb").write_bytes(data)
        try:
            gltf.read(tmp_path / "b.glb")
            outcomes[True] += 1
        except InputError:
            outcomes[False] += 1
    assert min(outcomes.values()) > 8


def test_no_such_file_and_folder(tmp_path):
    with pytest.raises(InputError, match=r"none\.glb: cannot be read: No such file"):
        gltf.read(tmp_path / "none.glb")
    with pytest.raises(InputError, match="no ordinary file"):
        gltf.read(tmp_path)
    os.mkfifo(tmp_path / "pipe.glb")
    with pytest.raises(InputError, match="no ordinary file"):
        gltf.read(tmp_path / "pipe.glb")


def test_gltf_that_is_neither(tmp_path):
    (tmp_path / "a.gltf").write_bytes(b"solid cube")
    with pytest.raises(InputError, match=r"header\.magic: wanted b'glTF' or a JSON object"):
        gltf.read(tmp_path / "a.gltf")


def test_missing_and_short_buffer_files(tmp_path):
    path = triangle().gltf(tmp_path / "a.gltf", "mesh.bin")
    size = (tmp_path / "mesh.bin").stat().st_size
    (tmp_path / "mesh.bin").write_bytes(b"1234")
    with pytest.raises(InputError, match=rf"byteLength: 'mesh\.bin' is too short: wanted {size} b"):
        gltf.read(path)
    (tmp_path / "mesh.bin").unlink()
    with pytest.raises(InputError, match=r"buffers\[0\]\.uri: missing file: wanted '.*mesh\.bin'"):
        gltf.read(path)
    os.mkfifo(tmp_path / "mesh.bin")
    with pytest.raises(InputError, match=r"buffers\[0\]\.uri: missing file"):
        gltf.read(path)


@pytest.fixture
def secret(tmp_path):
    """A scene in ``scene/`` and a buffer beside that folder."""
    (tmp_path / "scene").mkdir()
    b = triangle()
    (tmp_path / "secret.bin").write_bytes(b.binary)
    path = b.gltf(tmp_path / "scene" / "a.gltf")

    def use(uri: str):
        document = json.loads(path.read_text())
        document["buffers"][0]["uri"] = uri
        path.write_text(json.dumps(document))
        return path

    return use


@pytest.mark.parametrize(
    "uri",
    [
        "../secret.bin",
        "./../secret.bin",
        "sub/../../secret.bin",
        "..\\secret.bin",
        "%2e%2e/secret.bin",
        "%2e%2e%2fsecret.bin",
        "..%5csecret.bin",
        "{folder}/secret.bin",
        "file://{folder}/secret.bin",
        "file://localhost{folder}/secret.bin",
        "FILE:{folder}/secret.bin",
        "file:../secret.bin",
        "link.bin",
        "linked/secret.bin",
    ],
)
def test_uris_that_leave_the_folder(tmp_path, secret, uri):
    (tmp_path / "scene" / "link.bin").symlink_to(tmp_path / "secret.bin")
    (tmp_path / "scene" / "linked").symlink_to(tmp_path)
    path = secret(uri.format(folder=tmp_path))
    with pytest.raises(InputError, match=r"buffers\[0\]\.uri: leaves the scene's folder: wanted"):
        gltf.read(path)
    assert len(gltf.read(path, allow_dirs=[tmp_path]).meshes) == 1
    with pytest.raises(InputError, match="leaves the scene's folder"):
        gltf.read(path, allow_dirs=[tmp_path / "elsewhere"])


@pytest.mark.parametrize(
    ("uri", "wanted"),
    [
        ("http://example.org/a.bin", "refused: wanted a relative path or a data URI, got 'http:"),
        ("https://example.org/a.bin", "refused: wanted a relative path"),
        ("ftp://example.org/a.bin", "refused: wanted a relative path"),
        ("C:/windows/a.bin", "refused: wanted a relative path"),
        ("file://server/share/a.bin", "refused: wanted a local file"),
        ("", "refused: wanted the name of a file"),
        ("a\0b", "refused: wanted the name of a file"),
        ("a%00b", "refused: wanted the name of a file"),
        (".", "missing file"),
        ("x" * 5000, "missing file|refused"),
        ("/dev/zero", "leaves the scene's folder"),
        ("..", "leaves the scene's folder"),
        ("%252e%252e%252fsecret.bin", "missing file"),
    ],
)
def test_uris_that_are_refused(tmp_path, secret, uri, wanted):
    with pytest.raises(InputError, match=wanted):
        gltf.read(secret(uri))


def test_images_must_stay_too_even_unused_ones(tmp_path):
    (tmp_path / "scene").mkdir()
    (tmp_path / "secret.png").write_bytes(png(PIXELS))
    b = triangle()
    b.add("images", {"uri": "../secret.png"})
    with pytest.raises(InputError, match=r"images\[0\]\.uri: leaves the scene's folder"):
        gltf.read(b.glb(tmp_path / "scene" / "a.glb"))


def bomb(width: int, height: int) -> bytes:
    size = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        (chunk(b"IHDR", size), chunk(b"IDAT", b"\0" * 64), chunk(b"IEND", b""))
    )


def broken_images(folder) -> list[tuple[bytes, str]]:
    good, photo = png(PIXELS), jpeg(PIXELS, folder)
    flipped = bytearray(good)
    flipped[45] ^= 255
    return [
        (good[:-20], "truncated PNG"),
        (good[:33], "truncated PNG: wanted an IEND chunk"),
        (bytes(flipped), "corrupt PNG: wrong checksum of chunk b'IDAT'"),
        (photo[: len(photo) - 10], "truncated JPEG: wanted an end marker"),
        (photo[:20], "cannot be decoded: .*Premature end"),
        (bomb(60000, 60000), r"image size: wanted at most .* got 60000x60000"),
        (bomb(16384, 30000), "image size: wanted at most"),
        (bomb(8000, 8000), "truncated PNG: 64 bytes cannot hold 8000x8000"),
        (bomb(20, 20), r"cannot be decoded"),
        (bomb(0, 20), "image size: wanted at least 1x1, got 0x20"),
        (b"GIF89a" + bytes(20), "wanted a PNG, JPEG, WebP or KTX2 image, got b'GIF89a"),
    ]


@pytest.mark.parametrize("case", range(11))
def test_broken_images(tmp_path, case):
    data, wanted = broken_images(tmp_path)[case]
    b = full()
    packed = base64.b64encode(data).decode()
    b.json["images"][0] = {"name": "wood", "uri": "data:image/png;base64," + packed}
    path = b.glb(tmp_path / "a.glb")
    with pytest.raises(InputError, match=wanted) as caught:
        gltf.read(path)
    assert str(caught.value).startswith(f"{path}: images[0] ('wood'): ")
    assert "/tmp/daguerre-" not in str(caught.value)


def test_a_mesh_of_many_views_of_the_same_bytes(tmp_path):
    """Equal primitives share one mesh, so a small file cannot ask for gigabytes."""
    b = triangle()
    b.json["meshes"][0]["primitives"] *= 3000
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert len(scene.meshes) == 1
    assert len(scene.instances) == 3000
    assert scene.meshes[0].positions.tolist() == CORNERS
