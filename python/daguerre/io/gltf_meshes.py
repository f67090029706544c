"""Mesh primitives of glTF as triangles: lists, strips and fans, indexed or not.

Source: glTF 2.0 specification, chapters 3.7.2 and 5.24; KHR_mesh_quantization.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import given_up
from daguerre.scene import Scene

from .gltf_accessors import Accessors
from .gltf_nodes import MAX_SIZE
from .json_item import Item, clean
from .notes import Notes

FloatArray = NDArray[np.float32]
_MODES = ("points", "lines", "a line loop", "a line strip", "list", "strip", "fan")
_KNOWN = ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0")


class Meshes:
    """Reads primitives on demand; equal ones become one mesh of the scene.

    Args:
        root: The JSON object of the file.
        accessors: Its accessors.
        scene: Gets the meshes.
        notes: What was not understood.
    """

    def __init__(self, root: Item, accessors: Accessors, scene: Scene, notes: Notes) -> None:
        self.items = root.list_of("meshes")
        self._materials = len(root.list_of("materials"))
        self._accessors = accessors
        self._scene = scene
        self._notes = notes
        self._parts: dict[int, list[tuple[int, int | None]]] = {}
        self._shared: dict[tuple[Any, ...], int | None] = {}

    def parts(self, index: int) -> list[tuple[int, int | None]]:
        """The (mesh of the scene, material of the file or None) that a glTF mesh consists of."""
        if index not in self._parts:
            item = self.items[index]
            primitives = list(item.need("primitives"))
            name = item.name() or f"mesh{index}"
            self._parts[index] = []
            for primitive in primitives:
                full = name if len(primitives) == 1 else f"{name}/{primitive.key}"
                mesh = self._mesh(primitive, full)
                material = primitive.get("material")
                if mesh is not None:
                    chosen = (
                        None if material is None else material.index(self._materials, "materials")
                    )
                    self._parts[index].append((mesh, chosen))
        return self._parts[index]

    def _mesh(self, primitive: Item, name: str) -> int | None:
        mode_item = primitive.get("mode")
        mode = 4 if mode_item is None else mode_item.choice(range(7))
        attributes = {str(item.key): item for item in primitive.need("attributes").members()}
        if mode < 4:
            self._notes.add(f"a mesh primitive that is {_MODES[mode]} is left out")
            return None
        if primitive.list_of("targets"):
            self._notes.add("a mesh with morph targets is shown in its rest pose")
        if "POSITION" not in attributes:
            self._notes.add("a mesh primitive without POSITION is left out")
            return None
        indices = primitive.get("indices")
        key = (
            mode,
            None if indices is None else self._accessors.index(indices),
            *sorted((k, self._accessors.index(attributes[k])) for k in _KNOWN if k in attributes),
        )
        if key not in self._shared:
            self._shared[key] = self._read(primitive, attributes, indices, mode, name)
        return self._shared[key]

    def _read(
        self,
        primitive: Item,
        attributes: dict[str, Item],
        indices: Item | None,
        mode: int,
        name: str,
    ) -> int | None:
        self._note_unknown(attributes)
        positions = self._accessors.floats(attributes["POSITION"], ("VEC3",), "vertex")
        far = np.flatnonzero(np.abs(positions).max(axis=1) >= MAX_SIZE)
        if far.size:
            attributes["POSITION"].fail(
                f"vertex {far[0]}: wanted coordinates below {MAX_SIZE:g}, "
                f"got {positions[far[0]].tolist()}"
            )
        triangles = self._triangles(primitive, indices, mode, len(positions))
        if not len(triangles):
            self._notes.add("a mesh primitive without a triangle that has an area is left out")
            return None
        arrays = {
            key: self._attribute(attributes[key], len(positions))
            for key in _KNOWN[1:]
            if key in attributes
        }
        normals = arrays.get("NORMAL")
        if normals is not None:
            normals = self._unit_normals(normals, positions, triangles)
        optional = {
            "normals": normals,
            "uv": arrays.get("TEXCOORD_0"),
            "uv1": arrays.get("TEXCOORD_1"),
            "tangents": self._unit_tangents(arrays.get("TANGENT")),
            "colors": arrays.get("COLOR_0"),
        }
        self._scene.add_mesh(
            given_up(positions),
            given_up(triangles),
            **{key: given_up(values) for key, values in optional.items() if values is not None},
            name=name,
        )
        return len(self._scene.meshes) - 1

    def _note_unknown(self, attributes: dict[str, Item]) -> None:
        for key in attributes:
            # Names with an underscore belong to applications (3.7.2.1); skins speak for themselves.
            if key not in _KNOWN and not key.startswith(("_", "JOINTS_", "WEIGHTS_")):
                self._notes.add(f"mesh attribute {clean(key)[:40]!r} is not used")

    def _attribute(self, use: Item, count: int) -> FloatArray:
        types = {"NORMAL": ("VEC3",), "TANGENT": ("VEC4",), "COLOR_0": ("VEC3", "VEC4")}
        _, component, normalized = self._accessors.kind(use)
        if use.key == "COLOR_0" and not (
            component == 5126 or (component in (5121, 5123) and normalized)
        ):
            use.fail(
                "wrong accessor type: wanted float or normalized unsigned byte or short, got "
                f"component type {component}{'' if normalized else ', not normalized'}"
            )
        array = self._accessors.floats(use, types.get(str(use.key), ("VEC2",)), "vertex")
        if len(array) != count:
            use.fail(f"wrong count: wanted {count} like POSITION, got {len(array)}")
        return array

    def _triangles(
        self, primitive: Item, indices: Item | None, mode: int, count: int
    ) -> NDArray[np.uint32]:
        if indices is None:
            where, corners = primitive, np.arange(count, dtype=np.uint32)
        else:
            where, corners = indices, self._accessors.integers(indices)
            bad = np.flatnonzero(corners >= count)
            if bad.size:
                indices.fail(
                    f"element {bad[0]}: index out of range: wanted 0 .. {count - 1} (vertices), "
                    f"got {corners[bad[0]]} ({bad.size} such elements)"
                )
        if mode == 4:
            if len(corners) % 3:
                where.fail(f"wrong number of corners: wanted a multiple of 3, got {len(corners)}")
            return corners.reshape(-1, 3)
        if len(corners) < 3:
            where.fail(f"wrong number of corners: wanted at least 3, got {len(corners)}")
        if mode == 5:
            # Every second triangle of a strip is turned, so that all wind alike (3.7.2.1).
            i = np.arange(len(corners) - 2)
            strip = np.stack([corners[:-2], corners[i + 1 + i % 2], corners[i + 2 - i % 2]], axis=1)
            a, b, c = strip.T
            # Triangles without an area only stitch strips together.
            kept: NDArray[np.uint32] = strip[(a != b) & (b != c) & (a != c)]
            return kept
        hub = np.full(len(corners) - 2, corners[0], np.uint32)
        return np.stack([corners[1:-1], corners[2:], hub], axis=1)

    def _unit_normals(
        self, normals: FloatArray, positions: FloatArray, triangles: NDArray[np.uint32]
    ) -> FloatArray:
        """Unit length (quantised ones are not); where it is 0, the normal of a face there."""
        lengths = np.linalg.norm(normals.astype(np.float64), axis=1)
        empty = lengths == 0
        if empty.any():
            a, b, c = (positions[triangles[:, k]].astype(np.float64) for k in range(3))
            faces = np.cross(b - a, c - a)
            by_vertex = np.zeros_like(positions, np.float64)
            by_vertex[triangles.ravel()] = np.repeat(faces, 3, axis=0)
            normals[empty] = by_vertex[empty]
            lengths[empty] = np.linalg.norm(by_vertex[empty], axis=1)
            lost = lengths == 0
            normals[lost], lengths[lost] = (0, 1, 0), 1
            self._notes.add("a vertex normal of length 0 is replaced", int(empty.sum()))
        return np.asarray(normals / lengths[:, None], np.float32)

    def _unit_tangents(self, tangents: FloatArray | None) -> FloatArray | None:
        """Unit length and a sign; a mesh with tangents of length 0 is better without any."""
        if tangents is None:
            return None
        lengths = np.linalg.norm(tangents[:, :3].astype(np.float64), axis=1)
        if (lengths == 0).any():
            self._notes.add("tangents of length 0: the mesh's tangents are derived from its uv")
            return None
        tangents[:, :3] = tangents[:, :3] / lengths[:, None]
        tangents[:, 3] = np.where(tangents[:, 3] < 0, -1, 1)
        return tangents
