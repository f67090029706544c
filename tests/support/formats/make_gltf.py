"""Builds small glTF files in memory, right or wrong on purpose."""

from __future__ import annotations

import base64
import copy
import json
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
from numpy.typing import ArrayLike, NDArray

COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


class Builder:
    """A glTF document with one buffer that grows."""

    def __init__(self) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0"}}
        self.binary = bytearray()

    def add(self, kind: str, value: dict[str, Any]) -> int:
        """Appends to a top-level list; returns the index."""
        self.json.setdefault(kind, []).append(value)
        return len(self.json[kind]) - 1

    def view(self, data: bytes, **extra: Any) -> int:
        """Appends a bufferView."""
        self.binary += b"\0" * (-len(self.binary) % 4)
        offset = len(self.binary)
        self.binary += data
        return self.add(
            "bufferViews", {"buffer": 0, "byteOffset": offset, "byteLength": len(data), **extra}
        )

    def accessor(self, values: ArrayLike, dtype: str = "f4", **extra: Any) -> int:
        """Appends an accessor with its own bufferView."""
        array = np.asarray(values, "<" + dtype)
        array = array.reshape(len(array), -1)
        return self.add(
            "accessors",
            {
                "bufferView": self.view(array.tobytes()),
                "componentType": COMPONENTS[dtype],
                "count": len(array),
                "type": TYPES[array.shape[1]],
                **extra,
            },
        )

    def mesh(self, attributes: dict[str, int], **primitive: Any) -> int:
        """Appends a mesh of one primitive."""
        return self.add("meshes", {"primitives": [{"attributes": attributes, **primitive}]})

    def node(self, **values: Any) -> int:
        """Appends a node and makes it a root of scene 0."""
        index = self.add("nodes", values)
        self.json.setdefault("scene", 0)
        self.json.setdefault("scenes", [{"nodes": []}])[0]["nodes"].append(index)
        return index

    def child(self, **values: Any) -> int:
        """Appends a node that is no root."""
        return self.add("nodes", values)

    def image(self, data: bytes, **extra: Any) -> int:
        """Appends an image in a bufferView and a texture of it; returns the texture."""
        image = self.add("images", {"bufferView": self.view(data), "mimeType": "image/png"})
        return self.add("textures", {"source": image, **extra})

    def document(self) -> dict[str, Any]:
        """The JSON with the buffer's length filled in, unless a test set it."""
        document = copy.deepcopy(self.json)
        if self.binary and "buffers" not in document:
            document["buffers"] = [{"byteLength": len(self.binary)}]
        return document

    def glb(self, path: Path) -> Path:
        """Writes a .glb."""
        path.write_bytes(glb_bytes(json.dumps(self.document()).encode(), bytes(self.binary)))
        return path

    def gltf(self, path: Path, uri: str | None = None) -> Path:
        """Writes a .gltf; the buffer in a data URI, or beside it under ``uri``."""
        document = self.document()
        if uri is None:
            packed = base64.b64encode(self.binary).decode()
            document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + packed
        else:
            document["buffers"][0]["uri"] = uri
            (path.parent / uri).write_bytes(self.binary)
        path.write_text(json.dumps(document))
        return path


def glb_bytes(text: bytes, binary: bytes = b"") -> bytes:
    """A .glb of a JSON chunk and, if there is any, a BIN chunk."""
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        binary += b"\0" * (-len(binary) % 4)
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def triangle() -> Builder:
    """One indexed triangle in one node, the smallest scene."""
    b = Builder()
    b.mesh({"POSITION": b.accessor(CORNERS)}, indices=b.accessor([0, 1, 2], "u2"))
    b.node(mesh=0, name="tri")
    return b


def png(pixels: NDArray[Any]) -> bytes:
    """A PNG of (H, W, 1..4) pixels, uint8 or uint16."""
    height, width, channels = pixels.shape
    depth = pixels.dtype.itemsize * 8
    rows = pixels.astype(">u2" if depth == 16 else "u1").reshape(height, -1)
    raw = b"".join(b"\0" + row.tobytes() for row in rows)
    color = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    header = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        (chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(raw)), chunk(b"IEND", b""))
    )


def jpeg(pixels: NDArray[np.uint8], folder: Path) -> bytes:
    """A JPEG of (H, W, 3) pixels; ``folder`` is for a file on the way."""
    height, width, channels = pixels.shape
    path = folder / "made.jpg"
    out = oiio.ImageOutput.create(str(path))
    out.open(str(path), oiio.ImageSpec(width, height, channels, oiio.UINT8))
    out.write_image(pixels)
    out.close()
    return path.read_bytes()


def chunk(kind: bytes, data: bytes) -> bytes:
    """A PNG chunk with its checksum."""
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
