"""Attributes of Blender's geometry as arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import bpy


#: Property of the items of an attribute, columns, and type, by Blender's name of the type.
_KINDS: dict[str, tuple[str, int, type[np.generic]]] = {
    "FLOAT": ("value", 1, np.float32),
    "INT": ("value", 1, np.int32),
    "INT8": ("value", 1, np.int32),
    "BOOLEAN": ("value", 1, np.bool_),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),
}


def read(
    items: bpy.types.bpy_prop_collection, name: str, columns: int, kind: type[np.generic]
) -> NDArray[Any]:
    """Values of a property of all items, shape (N,) for one column, else (N, columns)."""
    flat = np.empty(len(items) * columns, kind)
    items.foreach_get(name, flat)
    return flat if columns == 1 else flat.reshape(-1, columns)


def attribute(geometry: bpy.types.Mesh | bpy.types.Curves, name: str) -> NDArray[Any] | None:
    """Values of an attribute, by its name; None: there is none, or it has no numbers.

    Colours are linear, of either type.
    """
    found = geometry.attributes.get(name)
    if found is None or found.data_type not in _KINDS:
        return None
    member, columns, kind = _KINDS[found.data_type]
    return read(found.data, member, columns, kind)


def points_of(geometry: bpy.types.Mesh | bpy.types.Curves) -> NDArray[np.float32]:
    """Positions of a mesh or of curves, shape (N, 3), in units of the scene."""
    found = attribute(geometry, "position")
    return np.zeros((0, 3), np.float32) if found is None else found
