"""Extensions of the whole file, and those of meshes, skins, instances, pointers and packed data."""

from __future__ import annotations

import json
from pathlib import Path

from tests.support.formats.make_gltf import Builder

from .bases import full, moving
from .case import Case, Change, both, primitive, put, scenes

N = r"nodes\[2\]\.extensions\.EXT_mesh_gpu_instancing"
POINTER = "animations.0.channels.0.target.extensions.KHR_animation_pointer"
STREAMS = json.loads((Path(__file__).parents[1] / "data/meshopt.json").read_text())["streams"]
MESHOPT = "bufferViews.0.extensions.EXT_meshopt_compression"
DRACO = "meshes.0.primitives.0.extensions.KHR_draco_mesh_compression"
VARIANTS = "KHR_materials_variants"
TWO = {"variants": [{"name": "day"}, {"name": "night"}]}

BAD: dict[str, tuple[Change, str]] = {
    "required and unknown": (
        put("extensionsRequired", ["EXT_texture_avif"]),
        r"extensionsRequired\[0\]: unknown extension: .*got 'EXT_texture_avif'",
    ),
    "required is text": (put("extensionsRequired", "KHR_x"), r"extensionsRequired: wrong type"),
    "used holds a number": (put("extensionsUsed", [3]), r"extensionsUsed\[0\]: wrong type"),
}


def instances(name: str, value: object) -> Change:
    return put(f"nodes.2.extensions.EXT_mesh_gpu_instancing.attributes.{name}", value)


def column(name: str, rows: list[list[float]]) -> Change:
    return lambda b: instances(name, b.accessor(rows))(b)


def pointer(text: object) -> Change:
    return put(POINTER + ".pointer", text)


MOVING: dict[str, tuple[Change, str]] = {
    "skin out of range": (put("nodes.0.skin", 7), r"nodes\[0\]\.skin: index out of range"),
    "skin is text": (put("nodes.0.skin", "0"), r"nodes\[0\]\.skin: wrong type"),
    "skins is an object": (put("skins", {}), r"skins: wrong type"),
    "no joints": (put("skins.0.joints", []), r"skins\[0\]\.joints: the list is empty"),
    "joints missing": (put("skins.0.joints", ...), r"skins\[0\]\.joints: missing"),
    "joint out of range": (put("skins.0.joints", [1, 99]), r"joints\[1\]: index out of range"),
    "joint is null": (put("skins.0.joints", [None, 1]), r"joints\[0\]: wrong type"),
    "skeleton out of range": (put("skins.0.skeleton", 99), r"skeleton: index out of range"),
    "bind matrices too few": (
        put("skins.0.joints", [1, 2, 1]),
        r"inverseBindMatrices: wrong count: wanted at least 3",
    ),
    "bind matrices of vectors": (
        put("skins.0.inverseBindMatrices", 0),
        r"inverseBindMatrices: wrong accessor type",
    ),
    "one joint, indices of two": (
        put("skins.0.joints", [1]),
        r"attributes\.JOINTS_0: vertex 0: index out of range",
    ),
    "weights missing": (
        put("meshes.0.primitives.0.attributes.WEIGHTS_0", ...),
        r"attributes\.JOINTS_0: WEIGHTS_0 is missing",
    ),
    "weights NaN": (
        primitive("WEIGHTS_0", lambda b: b.accessor([[float("nan")] * 4] * 3)),
        r"attributes\.WEIGHTS_0: vertex 0: wanted finite",
    ),
    "joints are floats": (
        primitive("JOINTS_0", lambda b: b.accessor([[0.0] * 4] * 3)),
        r"attributes\.JOINTS_0: wrong accessor type",
    ),
    "targets is an object": (put("meshes.0.primitives.0.targets", {}), r"targets: wrong type"),
    "target is null": (
        put("meshes.0.primitives.0.targets", [None, {}]),
        r"targets\[0\]: wrong type",
    ),
    "target out of range": (
        put("meshes.0.primitives.0.targets.0.POSITION", 99),
        r"targets\[0\]\.POSITION: index out of range",
    ),
    "target of another size": (
        lambda b: put("meshes.0.primitives.0.targets.0.POSITION", b.accessor([[0, 0, 0]]))(b),
        r"targets\[0\]\.POSITION: wrong count",
    ),
    "target Inf": (
        lambda b: put(
            "meshes.0.primitives.0.targets.0.POSITION", b.accessor([[float("inf"), 0, 0]] * 3)
        )(b),
        r"targets\[0\]\.POSITION: displacement 0: wanted finite",
    ),
    "weight is text": (put("meshes.0.weights", ["1", 0]), r"weights\[0\]: wrong type"),
    "weights too few": (
        both(put("animations", ...), put("meshes.0.weights", [1])),
        r"weights: wrong (length|number)",
    ),
    "weights of 1e300": (put("meshes.0.weights", [1e300, 0]), r"weights\[0\]: not finite"),
    "visible is 1": (
        both(put("animations", ...), put("nodes.1.extensions.KHR_node_visibility.visible", 1)),
        r"KHR_node_visibility\.visible: wrong type",
    ),
    "instances is a list": (
        put("nodes.2.extensions.EXT_mesh_gpu_instancing.attributes", []),
        N + r"\.attributes: wrong type",
    ),
    "instances of another count": (
        column("TRANSLATION", [[0, 0, 0]] * 3),
        N + r"\.attributes\.\w+: wrong count",
    ),
    "instances out of range": (instances("SCALE", 99), N + r"\.attributes\.SCALE: index out"),
    "instance rotation of length 0": (
        column("ROTATION", [[0, 0, 0, 1], [0, 0, 0, 0]]),
        N + r"\.attributes\.ROTATION: instance 1: wanted a quaternion of length 1",
    ),
    "instance at infinity": (
        column("TRANSLATION", [[float("inf"), 0, 0]] * 2),
        N + r"\.attributes\.TRANSLATION: instance 0: wanted finite",
    ),
    "instance at 1e30": (
        column("TRANSLATION", [[1e30, 0, 0]] * 2),
        r"nodes\[2\]: world transform: wanted numbers below",
    ),
    "instances 2^31": (
        lambda b: both(
            *(
                instances(
                    key,
                    b.add("accessors", {"componentType": 5126, "count": 2**31, "type": "VEC3"}),
                )
                for key in ("TRANSLATION", "SCALE")
            ),
            instances("ROTATION", ...),
            instances("_ID", ...),
        )(b),
        r"wanted at most|too large without a bufferView",
    ),
    "pointer is a number": (pointer(7), r"KHR_animation_pointer\.pointer: wrong type"),
    "pointer missing": (put(POINTER, {}), r"KHR_animation_pointer\.pointer: missing"),
    "pointer without a slash": (pointer("nodes/0"), r"pointer: wanted a JSON pointer"),
    "pointer with a tilde": (pointer("/nodes/~2"), r"pointer: wanted a JSON pointer"),
    "pointer to node 99": (pointer("/nodes/99/scale"), r"pointer: .*99"),
    "pointer to node 10^40": (pointer(f"/nodes/{10**40}/scale"), r"pointer: "),
    "pointer to node -1": (pointer("/nodes/-1/scale"), r"pointer: "),
}


def packed(**members: object) -> Change:
    """The first view is a meshopt stream, a grid of 40 positions."""

    def change(b: Builder) -> None:
        data = bytes.fromhex(STREAMS["positions v0"])
        view = b.view(data)
        place = b.json["bufferViews"][view]["byteOffset"]
        value = {
            "buffer": 0,
            "byteOffset": place,
            "byteLength": len(data),
            "byteStride": 12,
            "count": 40,
            "mode": "ATTRIBUTES",
        }
        put(MESHOPT, {k: v for k, v in (value | members).items() if v is not ...})(b)
        b.json["bufferViews"][0]["byteLength"] = 480
        b.json["buffers"] = [{"byteLength": len(b.binary)}]
        b.json["bufferViews"][0]["byteOffset"] = 0

    return change


X = r"bufferViews\[0\]"
V = X + r"\.extensions\.EXT_meshopt_compression"
PACKED: dict[str, tuple[Change, str]] = {
    "meshopt mode": (packed(mode="QUADS"), V + r"\.mode: unknown value"),
    "meshopt mode missing": (packed(mode=...), V + r"\.mode: missing"),
    "meshopt count 0": (packed(count=0), V + r"\.count: out of range"),
    "meshopt count 2^40": (packed(count=2**40), X + r"\.byteLength: wanted count x byteStride"),
    "meshopt stride 7": (packed(byteStride=7), V + r"\.byteStride: does not fit"),
    "meshopt stride 2^40": (packed(byteStride=2**40), V + r"\.byteStride: out of range"),
    "meshopt of another mode": (
        packed(mode="TRIANGLES", byteStride=4, count=120),
        V + r": .*wanted",
    ),
    "meshopt cut": (packed(byteLength=20), V + r": .*wanted"),
    "meshopt beyond": (packed(byteLength=2**40), V + r": beyond its buffer"),
    "meshopt buffer": (packed(buffer=9), V + r"\.buffer: index out of range"),
    "meshopt filter": (packed(filter="BLUR"), V + r"\.filter: unknown value"),
    "meshopt filter of another stride": (packed(filter="QUATERNION"), V + r"\.byteStride: does"),
    "meshopt is null": (put(MESHOPT, None), V + r": wrong type"),
    "draco is null": (put(DRACO, None), r"KHR_draco_mesh_compression: wrong type"),
    "draco of noise": (
        lambda b: put(DRACO, {"bufferView": b.view(b"DRACO" + bytes(60)), "attributes": {}})(b),
        r"KHR_draco_mesh_compression: ",
    ),
    "draco of 4 bytes": (
        lambda b: put(DRACO, {"bufferView": b.view(b"DRAC"), "attributes": {"POSITION": 0}})(b),
        r"KHR_draco_mesh_compression: ",
    ),
    "draco view": (
        put(DRACO, {"bufferView": 99, "attributes": {}}),
        r"KHR_draco_mesh_compression\.bufferView: index out|KHR_draco.*: wanted the package",
    ),
    "variants is a list": (put("extensions." + VARIANTS, []), VARIANTS + ": wrong type"),
    "variant without a name": (
        put("extensions." + VARIANTS, {"variants": [{}]}),
        VARIANTS + r"\.variants\[0\]\.name: missing",
    ),
    "mapping out of range": (
        both(
            put("extensions." + VARIANTS, TWO),
            put(
                "meshes.0.primitives.0.extensions." + VARIANTS,
                {"mappings": [{"material": 0, "variants": [2]}]},
            ),
        ),
        VARIANTS + r"\.mappings\[0\]\.variants\[0\]: index out of range",
    ),
    "mapping to nowhere": (
        both(
            put("extensions." + VARIANTS, TWO),
            put(
                "meshes.0.primitives.0.extensions." + VARIANTS,
                {"mappings": [{"material": 99, "variants": [0]}]},
            ),
        ),
        VARIANTS + r"\.mappings\[0\]\.material: index out of range",
    ),
    "webp out of range": (
        put("textures.0.extensions", {"EXT_texture_webp": {"source": 9}}),
        r"EXT_texture_webp\.source: index out of range",
    ),
    "basisu is a list": (
        put("textures.0.extensions", {"KHR_texture_basisu": []}),
        r"KHR_texture_basisu: wrong type",
    ),
}
CASES: list[Case] = [
    *scenes("extension", BAD, full),
    *scenes("moving", MOVING, moving),
    *scenes("packed", PACKED, full),
]
