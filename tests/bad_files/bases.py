"""The good scenes that the cases damage."""

from __future__ import annotations

import os
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tests.support.formats.make_gltf import Builder, png, triangle

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


def seen() -> Builder:
    """A textured wall of two triangles before the camera, with everything that can go bad."""
    b = Builder()
    corners = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]]
    attributes = {
        "POSITION": b.accessor(corners),
        "NORMAL": b.accessor([[0, 0, 1]] * 4),
        "TEXCOORD_0": b.accessor([[0, 1], [1, 1], [1, 0], [0, 0]]),
        "TANGENT": b.accessor([[1, 0, 0, 1]] * 4),
        "COLOR_0": b.accessor([[1, 1, 1, 1]] * 4),
    }
    b.image(png(PIXELS))
    b.add(
        "materials",
        {
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.5},
            "normalTexture": {"index": 0},
        },
    )
    b.mesh(attributes, indices=b.accessor([0, 1, 2, 0, 2, 3], "u2"), material=0)
    b.node(mesh=0, translation=[0, 0, -2], name="wall")
    b.add("cameras", {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}})
    b.node(camera=0, name="camera")
    return b


def beside_scene(name: str, put: Callable[[Path], object]) -> Callable[[Path], Path]:
    """A good scene, and a file beside it that ``put`` makes at its path."""

    def make(folder: Path) -> Path:
        seen().glb(folder / "scene.glb")
        put(folder / name)
        return folder / name

    return make


#: Files that never end, for ``beside_scene``.
ENDLESS: dict[str, Callable[[Path], object]] = {
    "pipe": os.mkfifo,
    "device": lambda path: path.symlink_to("/dev/zero"),
}
