"""Reads EXT_mesh_gpu_instancing: one mesh at many places, in columns of numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import Item, clean
from daguerre.files.notes import Notes
from daguerre.scene.transforms import compose

from .accessors import Accessors

_COLUMNS = ("TRANSLATION", "ROTATION", "SCALE")
#: Limit of instances of a scene, as an accessor without bytes could name any number.
MAX_INSTANCES = 1 << 20


def instance_transforms(
    node: Item, accessors: Accessors, notes: Notes
) -> NDArray[np.float64] | None:
    """Reads node from instance, shape (instances, 4, 4); None: the node is not instanced.

    Raises:
        InputError: The columns differ in length, or are not transforms.
    """
    extension = node.extension("EXT_mesh_gpu_instancing")
    listed = None if extension is None else extension.get("attributes")
    if listed is None:
        return None
    uses = {str(use.key): use for use in listed.members()}
    for name in uses:
        if name not in _COLUMNS and not name.startswith("_"):
            notes.add(f"instance attribute {clean(name)[:40]!r} is not used")
    count = _common_count(uses, accessors)

    def column(name: str, kind: str, default: tuple[float, ...]) -> NDArray[np.float64]:
        if name not in uses:
            return np.broadcast_to(np.array(default), (count, len(default)))
        return accessors.floats(uses[name], (kind,), "instance").astype(np.float64)

    rotations = column("ROTATION", "VEC4", (0.0, 0.0, 0.0, 1.0))
    lengths = np.linalg.norm(rotations, axis=1, keepdims=True)
    bad = np.flatnonzero(lengths < 1e-9)
    if bad.size:
        where = f"instance {bad[0]}: "
        uses["ROTATION"].fail(f"{where}wanted a quaternion of length 1, got length 0")
    places = column("TRANSLATION", "VEC3", (0.0, 0.0, 0.0))
    return compose(places, rotations / lengths, column("SCALE", "VEC3", (1.0, 1.0, 1.0)))


def _common_count(uses: dict[str, Item], accessors: Accessors) -> int:
    """Number of instances; 1 if there are only application-specific attributes."""
    counts = {name: accessors.count(use) for name, use in uses.items()}
    count = next((counts[name] for name in _COLUMNS if name in counts), 1)
    if count > MAX_INSTANCES:
        next(iter(uses.values())).fail(f"wanted at most {MAX_INSTANCES} instances, got {count}")
    for name, use in uses.items():
        if counts[name] != count and not uses.keys().isdisjoint(_COLUMNS):
            use.fail(f"wrong count: wanted {count} like the other attributes, got {counts[name]}")
    return count
