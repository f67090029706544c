"""A small glTF 2.0 writer: meshes, pictures, materials, nodes and animations into one .glb file."""

from __future__ import annotations

import json
import math
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

FLOAT, U16, U32 = 5126, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


@dataclass
class Shape:
    """Triangles in metres: positions (N, 3), normals (N, 3), uv (N, 2), indices (T, 3)."""

    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    uv: NDArray[np.float32]
    indices: NDArray[np.uint32]
    tangents: NDArray[np.float32] | None = None  # (N, 4), glTF's convention


class Glb:
    """Collects a scene and writes it. Every add_* returns the index that others refer to."""

    def __init__(self, generator: str) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0", "generator": generator}}
        self.binary = bytearray()
        self.roots: list[int] = []

    def _add(self, key: str, item: dict[str, Any]) -> int:
        items = self.json.setdefault(key, [])
        items.append(item)
        return len(items) - 1

    def _view(self, data: bytes, **extra: Any) -> int:
        self.binary += b"\0" * (-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **extra}
        self.binary += data
        return self._add("bufferViews", view)

    def _accessor(self, array: ArrayLike, kind: str, component: int, **view: Any) -> int:
        dtype = {FLOAT: "<f4", U16: "<u2", U32: "<u4"}[component]
        data = np.ascontiguousarray(array, dtype=dtype)
        item = {
            "bufferView": self._view(data.tobytes(), **view),
            "componentType": component,
            "count": len(data),
            "type": kind,
        }
        if kind == "VEC3" or "target" not in view:  # positions and key times need bounds
            flat = data.reshape(len(data), -1)
            item |= {"min": flat.min(0).tolist(), "max": flat.max(0).tolist()}
        return self._add("accessors", item)

    def use(self, *extensions: str) -> None:
        """Names glTF extensions that the file uses (none is required to read it)."""
        used = set(self.json.get("extensionsUsed", [])) | set(extensions)
        self.json["extensionsUsed"] = sorted(used)

    def add_picture(self, name: str, data: bytes) -> dict[str, int]:
        """Embeds PNG or JPEG bytes; returns a texture reference for a material."""
        mime = "image/png" if data.startswith(b"\x89PNG") else "image/jpeg"
        if "samplers" not in self.json:  # linear with mipmaps, repeat
            self._add("samplers", {"magFilter": 9729, "minFilter": 9987})
        image = {"bufferView": self._view(data), "mimeType": mime, "name": name}
        source = self._add("images", image)
        return {"index": self._add("textures", {"source": source, "sampler": 0})}

    def add_material(self, name: str, **properties: Any) -> int:
        """Adds a material in glTF's own terms; extensions are noted as used."""
        self.use(*properties.get("extensions", {}))
        return self._add("materials", {"name": name, **properties})

    def add_mesh(self, name: str, shape: Shape, material: int) -> int:
        """Adds a mesh of one primitive."""
        attributes = {
            "POSITION": self._accessor(shape.positions, "VEC3", FLOAT, target=ARRAY_BUFFER),
            "NORMAL": self._accessor(shape.normals, "VEC3", FLOAT, target=ARRAY_BUFFER),
            "TEXCOORD_0": self._accessor(shape.uv, "VEC2", FLOAT, target=ARRAY_BUFFER),
        }
        if shape.tangents is not None:
            tangents = self._accessor(shape.tangents, "VEC4", FLOAT, target=ARRAY_BUFFER)
            attributes["TANGENT"] = tangents
        component = U16 if len(shape.positions) < 65535 else U32
        flat = shape.indices.reshape(-1)
        indices = self._accessor(flat, "SCALAR", component, target=ELEMENT_ARRAY_BUFFER)
        primitive = {"attributes": attributes, "indices": indices, "material": material}
        return self._add("meshes", {"name": name, "primitives": [primitive]})

    def add_node(self, name: str, parent: int | None = None, **properties: Any) -> int:
        """Adds a node below `parent`, or at the root: translation, rotation (xyzw), scale, mesh."""
        for key in ("translation", "rotation", "scale"):
            if key in properties:
                properties[key] = [float(x) for x in properties[key]]
        node = self._add("nodes", {"name": name, **properties})
        if parent is None:
            self.roots.append(node)
        else:
            self.json["nodes"][parent].setdefault("children", []).append(node)
        return node

    def add_camera(self, name: str, focal_length_mm: float, f_stop: float, focus_m: float) -> int:
        """Adds a 36 x 24 mm camera: glTF's perspective, and EXT_camera_physical for the rest."""
        physical = {
            "sensorSize": [36, 24],
            "focalLength": focal_length_mm,
            "fStop": f_stop,
            "focusDistance": focus_m,
        }
        yfov = 2 * math.atan(12 / focal_length_mm)
        self.use("EXT_camera_physical")
        camera = {
            "name": name,
            "type": "perspective",
            "perspective": {"aspectRatio": 1.5, "yfov": yfov, "znear": 0.01},
            "extensions": {"EXT_camera_physical": physical},
        }
        return self._add("cameras", camera)

    def add_turns(self, name: str, turns: dict[int, int], duration_s: float) -> None:
        """Animates nodes: each makes a whole number of turns about its y axis, evenly."""
        samplers: list[dict[str, Any]] = []
        channels: list[dict[str, Any]] = []
        for node, count in turns.items():
            angles = np.linspace(0, 2 * math.pi * count, 3 * abs(count) + 1)  # 120 deg per key
            times = np.linspace(0, duration_s, len(angles))
            zero = np.zeros_like(angles)
            keys = np.stack([zero, np.sin(angles / 2), zero, np.cos(angles / 2)], 1)
            sampler = {
                "input": self._accessor(times, "SCALAR", FLOAT),
                "output": self._accessor(keys, "VEC4", FLOAT),
                "interpolation": "LINEAR",
            }
            target = {"node": node, "path": "rotation"}
            channels.append({"sampler": len(samplers), "target": target})
            samplers.append(sampler)
        self._add("animations", {"name": name, "samplers": samplers, "channels": channels})

    def write(self, path: Path) -> None:
        """Writes the .glb: a header, the JSON chunk, the binary chunk (glTF 2.0, section 4.4)."""
        self.json |= {"scene": 0, "scenes": [{"nodes": self.roots}]}
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + len(self.binary)
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, size))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)
