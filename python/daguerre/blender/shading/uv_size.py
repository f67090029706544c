"""Length of one unit of texture coordinates on the surfaces of a material, for bumps."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import bpy


Array = NDArray[Any]


def uv_size(material: bpy.types.Material) -> float:
    """Length in scene units: root of the area in space over that in texture coordinates.

    The first mesh that has both counts, in the size of its object; without one the length is 1.
    """
    for mesh, slots, scale in _meshes(material):
        space, plane = _areas(mesh, slots)
        if space > 0 and plane > 0:
            return math.sqrt(space / plane) * scale
    return 1.0


def _meshes(material: bpy.types.Material) -> Iterator[tuple[Any, list[int], float]]:
    """Meshes that use a material, the numbers of its slots, and the scale of their objects."""
    import bpy

    for one in bpy.data.objects:
        if one.type != "MESH":
            continue
        slots = [
            i
            for i, slot in enumerate(one.material_slots)
            if slot.material is not None and slot.material.name_full == material.name_full
        ]
        if slots and one.data.uv_layers.active is not None:
            x, y, z = one.matrix_world.to_scale()
            yield one.data, slots, float(abs(x * y * z)) ** (1 / 3)


def _areas(mesh: bpy.types.Mesh, slots: list[int]) -> tuple[float, float]:
    """Areas of the faces of some slots, in space and in texture coordinates."""
    count = len(mesh.polygons)
    space, slot = np.empty(count, np.float32), np.empty(count, np.int32)
    start, total = np.empty(count, np.int32), np.empty(count, np.int32)
    mesh.polygons.foreach_get("area", space)
    mesh.polygons.foreach_get("material_index", slot)
    mesh.polygons.foreach_get("loop_start", start)
    mesh.polygons.foreach_get("loop_total", total)
    layer = next((one for one in mesh.uv_layers if one.active_render), mesh.uv_layers.active)
    uv = np.empty(2 * len(layer.uv), np.float32)
    layer.uv.foreach_get("vector", uv)
    chosen = np.isin(slot, slots) & (total > 2)
    plane = _signed_areas(uv.reshape(-1, 2).astype(np.float64), start[chosen], total[chosen])
    return float(space[chosen].sum(dtype=np.float64)), float(np.abs(plane).sum())


def _signed_areas(uv: Array, start: Array, total: Array) -> Array:
    """Areas of polygons of corners that follow each other, by Gauss's formula."""
    if not len(start):
        return np.zeros(0)
    face = np.repeat(np.arange(len(start)), total)
    within = np.arange(len(face)) - np.repeat(np.cumsum(total) - total, total)
    here = start[face] + within
    there = start[face] + (within + 1) % total[face]
    cross = uv[here, 0] * uv[there, 1] - uv[there, 0] * uv[here, 1]
    return np.asarray(np.bincount(face, cross, len(start)) / 2)
