"""Small writers of files of meshes and grids, and of files that lie."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

_NAMES = {"i1": "char", "u1": "uchar", "i2": "short", "u2": "ushort", "i4": "int", "u4": "uint",
          "f4": "float", "f8": "double"}  # fmt: skip
_FORMATS = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}


def ply_header(order: str, *lines: str) -> bytes:
    """A header of these lines."""
    text = "\n".join(["ply", f"format {_FORMATS[order]} 1.0", *lines, "end_header"])
    return (text + "\n").encode()


def ply(
    vertices: Mapping[str, Any],
    faces: Sequence[Sequence[int]],
    order: str = "<",
    *,
    kinds: Mapping[str, str] | None = None,
    length: str = "u1",
    index: str = "i4",
    name: str = "vertex_indices",
    uv: Sequence[Sequence[float]] | None = None,
) -> bytes:
    """A PLY file.

    Args:
        vertices: Columns.
        faces: Vertices of each face.
        order: "", "<" or ">".
        kinds: Types of columns; default: f4.
        length: Type of the lengths of faces.
        index: Type of their vertices.
        name: Name of their list.
        uv: Texture coordinates of the corners of each face.
    """
    types = {key: (kinds or {}).get(key, "f4") for key in vertices}
    count = len(next(iter(vertices.values())))
    head = ["comment made for a test", f"element vertex {count}"]
    head += [f"property {_NAMES[types[key]]} {key}" for key in vertices]
    head += [f"element face {len(faces)}"]
    head += [f"property list {_NAMES[length]} {_NAMES[index]} {name}"]
    if uv is not None:
        head.append("property list uchar float texcoord")
    rows = np.zeros(count, [(key, order + types[key]) for key in vertices])
    for key, column in vertices.items():
        rows[key] = column
    if not order:
        lines = [" ".join(repr(one.item()) for one in row) for row in rows]
        for i, face in enumerate(faces):
            words = [len(face), *face]
            if uv is not None:
                words += [len(uv[i]), *uv[i]]
            lines.append(" ".join(map(str, words)))
        return ply_header(order, *head) + ("\n".join(lines) + "\n").encode()
    body = [rows.tobytes()]
    for i, face in enumerate(faces):
        body.append(np.array([len(face)], order + length).tobytes())
        body.append(np.array(face, order + index).tobytes())
        if uv is not None:
            body.append(np.array([len(uv[i])], "u1").tobytes())
            body.append(np.array(uv[i], order + "f4").tobytes())
    return ply_header(order, *head) + b"".join(body)


def serialized(meshes: Sequence[Mapping[str, Any]], version: int = 4, kind: str = "<f4") -> bytes:
    """A serialized file of Mitsuba.

    Args:
        meshes: Each with ``positions`` and ``triangles``, and perhaps ``normals``, ``uv``,
            ``colors``, ``name`` and ``flags``.
        version: Version of the format.
        kind: Type of numbers.
    """
    out, begins = b"", []
    for mesh in meshes:
        flags = int(mesh.get("flags", 0)) | (0x2000 if kind == "<f8" else 0x1000)
        body = b""
        if version == 4:
            body += str(mesh.get("name", "")).encode() + b"\0"
        body += struct.pack("<QQ", len(mesh["positions"]), len(mesh["triangles"]))
        body += np.asarray(mesh["positions"], kind).tobytes()
        for flag, key in ((1, "normals"), (2, "uv"), (8, "colors")):
            if key in mesh:
                flags |= flag
                body += np.asarray(mesh[key], kind).tobytes()
        body += np.asarray(mesh["triangles"], "<u4").tobytes()
        begins.append(len(out))
        out += struct.pack("<HH", 0x041C, version)
        out += zlib.compress(struct.pack("<I", flags) + body)
    place = "<Q" if version == 4 else "<I"
    return (
        out + b"".join(struct.pack(place, one) for one in begins) + struct.pack("<I", len(begins))
    )


def vol(values: NDArray[Any], box: Sequence[float] = (0, 0, 0, 1, 1, 1), kind: int = 1) -> bytes:
    """A grid of Mitsuba; values (Z, Y, X, C) are of type ``kind``."""
    z, y, x, channels = values.shape
    head = b"VOL" + struct.pack("<B5i6f", 3, kind, x, y, z, channels, *box)
    types = {1: "<f4", 2: "<f2", 3: "u1"}
    return head + np.ascontiguousarray(values, types.get(kind, "<f4")).tobytes()
