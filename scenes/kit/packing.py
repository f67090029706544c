"""Meshes made small: whole numbers instead of floats, meshopt's streams, and Draco's.

The encoders of meshopt are the plainest that the format allows. DracoPy, of the extra
`compression`, packs for Draco. Sources: KHR_mesh_quantization; the README of
KHR_meshopt_compression, appendix B (attributes of version 0, index sequences).
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.exporters.gltf import FLOAT, I8, I16, U16, U32, Glb, Shape

DRACO = "KHR_draco_mesh_compression"


def add_quantized(
    glb: Glb, name: str, shape: Shape, material: int, meshopt: str = ""
) -> tuple[int, dict[str, Any]]:
    """Adds a mesh in whole numbers; `meshopt` ("EXT" or "KHR") packs them further.

    Returns:
        The mesh, and the translation and scale of a node that undo the quantization.
    """
    low, high = shape.positions.min(0), shape.positions.max(0)
    centre, half = (low + high) / 2, float((high - low).max()) / 2
    whole = np.rint((shape.positions - centre) / half * 32767)
    columns = {
        "POSITION": ("VEC3", I16, whole),
        "NORMAL": ("VEC3", I8, np.rint(shape.normals * 127)),
        "TEXCOORD_0": ("VEC2", U16, np.rint(shape.uv.clip(0, 1) * 65535)),
    }
    attributes = {
        key: _column(glb, *column, meshopt, normalized=True) for key, column in columns.items()
    }
    indices = _column(glb, "SCALAR", U32, shape.indices.reshape(-1, 1), meshopt)
    glb.use("KHR_mesh_quantization", required=True)
    mesh = glb.add_primitive(name, attributes=attributes, indices=indices, material=material)
    return mesh, {"translation": centre.tolist(), "scale": [half] * 3}


def add_draco(glb: Glb, name: str, shape: Shape, material: int) -> int:
    """Adds a mesh as one Draco stream: 14 bits per coordinate, 10 per normal, 12 per uv."""
    draco = import_module("DracoPy")
    bits = {"quantization_bits": 14, "normal_quantization_bits": 10}
    stream = draco.encode(
        shape.positions,
        shape.indices,
        normals=shape.normals.astype(float),
        tex_coord=shape.uv.astype(float),
        tex_coord_quantization_bits=12,
        **bits,
    )
    mesh = draco.decode(stream)  # the encoder numbers and sorts as it likes
    types = {0: "POSITION", 1: "NORMAL", 3: "TEXCOORD_0"}
    identities, attributes = {}, {}
    for attribute in mesh.attributes:
        key, data = types[attribute["attribute_type"]], np.asarray(attribute["data"])
        identities[key] = attribute["unique_id"]
        kind = f"VEC{data.shape[1]}"
        claim = {"componentType": FLOAT, "count": len(data), "type": kind}
        if key == "POSITION":
            claim |= {"min": data.min(0).tolist(), "max": data.max(0).tolist()}
        attributes[key] = glb.add("accessors", claim)
    count = np.asarray(mesh.faces).size
    indices = glb.add("accessors", {"componentType": U32, "count": count, "type": "SCALAR"})
    extension = {"bufferView": glb.add_view(stream), "attributes": identities}
    glb.use(DRACO, required=True)
    return glb.add_primitive(
        name,
        attributes=attributes,
        indices=indices,
        material=material,
        extensions={DRACO: extension},
    )


def _column(
    glb: Glb, kind: str, component: int, values: ArrayLike, meshopt: str, **more: Any
) -> int:
    """An accessor of whole numbers, each row on a multiple of four bytes."""
    dtype = {I8: "i1", I16: "<i2", U16: "<u2", U32: "<u4"}[component]
    data = np.asarray(values, dtype)
    item = {"componentType": component, "count": len(data), "type": kind, **more}
    if kind == "VEC3" and component == I16:
        item |= {"min": data.min(0).tolist(), "max": data.max(0).tolist()}
    per_row = max(1, 4 // data.itemsize)
    rows = np.pad(data, ((0, 0), (0, -data.shape[1] % per_row)))
    stride = rows.shape[1] * data.itemsize
    strided = {} if kind == "SCALAR" else {"byteStride": stride}
    if not meshopt:
        return glb.add("accessors", {**item, "bufferView": glb.add_view(rows.tobytes(), **strided)})
    raw = rows.view(np.uint8).reshape(len(rows), stride)
    stream = pack_indices(data[:, 0]) if kind == "SCALAR" else pack_attributes(raw)
    mode = "INDICES" if kind == "SCALAR" else "ATTRIBUTES"
    view = _packed_view(glb, stream, rows.nbytes, f"{meshopt}_meshopt_compression")
    extension = {"byteStride": stride, "count": len(rows), "mode": mode}
    next(iter(glb.json["bufferViews"][view]["extensions"].values())).update(extension)
    glb.json["bufferViews"][view] |= strided
    return glb.add("accessors", {**item, "bufferView": view})


def _packed_view(glb: Glb, stream: bytes, length: int, name: str) -> int:
    """A bufferView on a buffer without bytes, whose extension says where they are."""
    glb.use(name, required=True)
    key = {"extensions": {name: {"fallback": True}}}
    numbers = [n for n, buffer in enumerate(glb.fallbacks) if key.items() <= buffer.items()]
    if not numbers:
        numbers = [len(glb.fallbacks)]
        glb.fallbacks.append({"byteLength": 0, **key})
    fallback = glb.fallbacks[numbers[0]]
    offset = fallback["byteLength"]
    fallback["byteLength"] += -(-length // 4) * 4
    index = glb.add_view(stream)
    view = glb.json["bufferViews"][index]
    view["extensions"] = {name: dict(view)}
    view |= {"buffer": 1 + numbers[0], "byteOffset": offset, "byteLength": length}
    return index


def pack_indices(indices: NDArray[np.uint32]) -> bytes:
    """An index sequence: each less the one before, zigzag, in groups of seven bits."""
    out = bytearray([0xD1])
    for step in np.diff(indices.astype(np.int64), prepend=0).tolist():
        value = (step << 1 ^ step >> 63) << 1  # the lowest bit chooses one of two neighbours
        while value > 127:
            out.append(value & 127 | 128)
            value >>= 7
        out.append(value)
    return bytes(out) + bytes(4)


def pack_attributes(rows: NDArray[np.uint8]) -> bytes:
    """Rows of bytes (N, stride): each byte less that of the row before, in groups of sixteen."""
    count, stride = rows.shape
    steps = np.diff(rows, axis=0, prepend=rows[:1]).astype(np.int8)
    zigzag = ((steps >> 7) ^ (steps << 1)).astype(np.uint8)
    out, block = bytearray([0xA0]), min(8192 // stride & ~15, 256)
    for first in range(0, count, block):
        part = zigzag[first : first + block]
        part = np.pad(part, ((0, -len(part) % 16), (0, 0)))
        for column in part.T:
            out += _groups(column.reshape(-1, 16))
    return bytes(out) + rows[0].tobytes().rjust(32, b"\0")


def _groups(groups: NDArray[np.uint8]) -> bytes:
    """Two bits per group say how its 16 numbers are stored: not at all, in 4 bits, or in 8."""
    modes = np.where(groups.max(1) == 0, 0, np.where(groups.max(1) < 15, 2, 3))
    quads = np.pad(modes, (0, -len(modes) % 4)).reshape(-1, 4)
    heads = (quads << [0, 2, 4, 6]).sum(1).astype(np.uint8)
    bodies = [
        b"" if mode == 0 else (g[::2] << 4 | g[1::2]).tobytes() if mode == 2 else g.tobytes()
        for mode, g in zip(modes, groups, strict=True)
    ]
    return heads.tobytes() + b"".join(bodies)
