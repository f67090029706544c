"""Writes meshes, pictures, materials, nodes and animations into one .glb file (glTF 2.0).

The writer is public; charts and the programs in ``scenes/`` write their files with it.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.files.atomic import write_bytes

I8, U8, I16, U16, U32, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
DTYPES = {I8: "i1", U8: "u1", I16: "<i2", U16: "<u2", U32: "<u4", FLOAT: "<f4"}
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
FORMATS = (
    (b"\x89PNG", "image/png", None),
    (b"\xff\xd8", "image/jpeg", None),
    (b"RIFF", "image/webp", "EXT_texture_webp"),
    (b"\xabKTX 20", "image/ktx2", "KHR_texture_basisu"),
)


@dataclass
class Shape:
    """Triangles in metres: positions (N, 3), normals (N, 3), uv (N, 2), indices (T, 3)."""

    positions: NDArray[np.float32]
    normals: NDArray[np.float32]
    uv: NDArray[np.float32]
    indices: NDArray[np.uint32]
    tangents: NDArray[np.float32] | None = None  # (N, 4), glTF's convention


@dataclass
class Track:
    """An animated value: glTF's target, key times in s, and one row of numbers per key."""

    target: dict[str, Any]
    times: ArrayLike
    keys: ArrayLike
    interpolation: str = "LINEAR"

    @classmethod
    def to(cls, pointer: str, times: ArrayLike, keys: ArrayLike, kind: str = "LINEAR") -> Track:
        """Makes a track for any value of the file, by its JSON pointer."""
        extensions = {"KHR_animation_pointer": {"pointer": pointer}}
        return cls({"path": "pointer", "extensions": extensions}, times, keys, kind)


class Glb:
    """Collects a scene and writes it; ``add_*`` methods return the index of the new item."""

    def __init__(self, generator: str) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0", "generator": generator}}
        self.binary = bytearray()
        self.roots: list[int] = []
        self.fallbacks: list[dict[str, Any]] = []  # buffers without bytes

    def add(self, key: str, item: dict[str, Any]) -> int:
        """Adds an item to one of the lists of the file."""
        items = self.json.setdefault(key, [])
        items.append(item)
        return len(items) - 1

    def add_view(self, data: bytes, **extra: object) -> int:
        """Adds bytes as a bufferView."""
        self.binary += b"\0" * (-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **extra}
        self.binary += data
        return self.add("bufferViews", view)

    def add_accessor(self, array: ArrayLike, kind: str, component: int, **view: object) -> int:
        """Adds an array, one row per element; `view` goes to its bufferView."""
        data = np.ascontiguousarray(array, dtype=DTYPES[component])
        item = {
            "bufferView": self.add_view(data.tobytes(), **view),
            "componentType": component,
            "count": len(data),
            "type": kind,
        }
        if kind == "VEC3" or "target" not in view:  # positions and key times need bounds
            flat = data.reshape(len(data), -1)
            item |= {"min": flat.min(0).tolist(), "max": flat.max(0).tolist()}
        return self.add("accessors", item)

    def use(self, *extensions: str, required: bool = False) -> None:
        """Lists glTF extensions as used, or also as required."""
        for key in ("extensionsUsed", "extensionsRequired")[: 1 + required]:
            named = sorted({*self.json.get(key, []), *extensions})
            if named:
                self.json[key] = named

    def add_picture(self, name: str, data: bytes) -> dict[str, int]:
        """Embeds PNG, JPEG, WebP or KTX2 bytes; returns a texture reference for a material."""
        mime, extension = next(form for magic, *form in FORMATS if data.startswith(magic))
        if "samplers" not in self.json:  # linear with mipmaps, repeat
            self.add("samplers", {"magFilter": 9729, "minFilter": 9987})
        image = {"bufferView": self.add_view(data), "mimeType": mime, "name": name}
        source = self.add("images", image)
        texture: dict[str, Any] = {"source": source}
        if extension:
            self.use(extension, required=True)
            texture = {"extensions": {extension: texture}}
        return {"index": self.add("textures", {**texture, "sampler": 0})}

    def add_material(self, name: str, **properties: Any) -> int:
        """Adds a material in glTF's own terms; extensions are noted as used."""
        self.use(*properties.get("extensions", {}))
        return self.add("materials", {"name": name, **properties})

    def primitive(
        self, shape: Shape, material: int, more: dict[str, int] | None = None, **primitive: object
    ) -> dict[str, Any]:
        """Makes a primitive of a mesh, with `more` attributes by their accessors."""
        attributes = {
            "POSITION": self.add_accessor(shape.positions, "VEC3", FLOAT, target=ARRAY_BUFFER),
            "NORMAL": self.add_accessor(shape.normals, "VEC3", FLOAT, target=ARRAY_BUFFER),
            "TEXCOORD_0": self.add_accessor(shape.uv, "VEC2", FLOAT, target=ARRAY_BUFFER),
        }
        if shape.tangents is not None:
            tangents = self.add_accessor(shape.tangents, "VEC4", FLOAT, target=ARRAY_BUFFER)
            attributes["TANGENT"] = tangents
        component = U16 if len(shape.positions) < 65535 else U32
        flat = shape.indices.reshape(-1)
        indices = self.add_accessor(flat, "SCALAR", component, target=ELEMENT_ARRAY_BUFFER)
        attributes |= more or {}
        return {"attributes": attributes, "indices": indices, "material": material, **primitive}

    def add_mesh(
        self,
        name: str,
        shape: Shape,
        material: int,
        more: dict[str, int] | None = None,
        **primitive: object,
    ) -> int:
        """Adds a mesh of one primitive, with `more` attributes by their accessors."""
        return self.add_primitive(name, **self.primitive(shape, material, more, **primitive))

    def add_parts(self, name: str, parts: Sequence[tuple[Shape, int]]) -> int:
        """Adds one mesh of several shapes, each with a material."""
        primitives = [self.primitive(shape, material) for shape, material in parts]
        return self.add("meshes", {"name": name, "primitives": primitives})

    def add_primitive(self, name: str, **primitive: Any) -> int:
        """Adds a mesh of one primitive in glTF's terms; extensions are noted as used."""
        self.use(*primitive.get("extensions", {}))
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def add_node(self, name: str, parent: int | None = None, **properties: Any) -> int:
        """Adds a node below `parent`, or at the root: translation, rotation (xyzw), scale, mesh."""
        for key in ("translation", "rotation", "scale"):
            if key in properties:
                properties[key] = [float(x) for x in properties[key]]
        node = self.add("nodes", {"name": name, **properties})
        if parent is None:
            self.roots.append(node)
        else:
            self.json["nodes"][parent].setdefault("children", []).append(node)
        return node

    def add_camera(
        self,
        name: str,
        focal_length_mm: float,
        f_stop: float,
        focus_m: float,
        sensor_mm: tuple[float, float] = (36, 24),
    ) -> int:
        """Adds a camera: glTF's perspective, and EXT_camera_physical for the rest."""
        physical = {
            "sensorSize": list(sensor_mm),
            "focalLength": focal_length_mm,
            "fStop": f_stop,
            "focusDistance": focus_m,
        }
        yfov = 2 * math.atan(sensor_mm[1] / 2 / focal_length_mm)
        self.use("EXT_camera_physical")
        camera = {
            "name": name,
            "type": "perspective",
            "perspective": {
                "aspectRatio": sensor_mm[0] / sensor_mm[1],
                "yfov": yfov,
                "znear": 0.01,
            },
            "extensions": {"EXT_camera_physical": physical},
        }
        return self.add("cameras", camera)

    def add_turns(self, name: str, turns: dict[int, int], duration_s: float) -> None:
        """Animates nodes, which make whole turns about their y axes at constant speed."""
        tracks = []
        for node, count in turns.items():
            angles = np.linspace(0, 2 * math.pi * count, 3 * abs(count) + 1)  # 120 deg per key
            times = np.linspace(0, duration_s, len(angles))
            zero = np.zeros_like(angles)
            keys = np.stack([zero, np.sin(angles / 2), zero, np.cos(angles / 2)], 1)
            target = {"node": node, "path": "rotation"}
            tracks.append(Track(target, times, keys))
        self.add_animation(name, tracks)

    def add_animation(self, name: str, tracks: list[Track]) -> None:
        """Adds an animation of all tracks, which play at once."""
        samplers: list[dict[str, Any]] = []
        channels: list[dict[str, Any]] = []
        for track in tracks:
            keys = np.asarray(track.keys)
            component = U8 if keys.dtype == bool else FLOAT
            if track.target["path"] == "weights" or keys.ndim == 1:
                keys, kind = keys.reshape(-1), "SCALAR"
            else:
                kind = f"VEC{keys.shape[1]}"
            sampler = {
                "input": self.add_accessor(track.times, "SCALAR", FLOAT),
                "output": self.add_accessor(keys, kind, component),
                "interpolation": track.interpolation,
            }
            self.use(*track.target.get("extensions", {}))
            channels.append({"sampler": len(samplers), "target": track.target})
            samplers.append(sampler)
        self.add("animations", {"name": name, "samplers": samplers, "channels": channels})

    def write(self, path: Path) -> None:
        """Writes the .glb: a header, the JSON chunk, the binary chunk (glTF 2.0, section 4.4)."""
        self.json |= {"scene": 0, "scenes": [{"nodes": self.roots}]}
        self.binary += b"\0" * (-len(self.binary) % 4)
        main = [{"byteLength": len(self.binary)}] if self.binary else []
        if main or self.fallbacks:
            self.json["buffers"] = [*main, *self.fallbacks]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        body = struct.pack("<I4s", len(text), b"JSON") + text
        if self.binary:
            body += struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary
        data = struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body
        path.parent.mkdir(parents=True, exist_ok=True)
        write_bytes(path, data)
