"""Applies morph targets: weighted sums of displacements shift vertices.

Source: glTF 2.0 specification, chapters 3.7.2.2 and 3.7.4; KHR_mesh_quantization.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import Item, clean
from daguerre.files.notes import Notes, Silence
from daguerre.files.value import Value

from .accessors import Accessors

FloatArray = NDArray[np.float32]
_TYPES = {
    "POSITION": ("VEC3",),
    "NORMAL": ("VEC3",),
    "TANGENT": ("VEC3",),  # the sign of a tangent does not change
    "TEXCOORD_0": ("VEC2",),
    "TEXCOORD_1": ("VEC2",),
    "COLOR_0": ("VEC3", "VEC4"),
}


@dataclass(frozen=True)
class Displacement:
    """An accessor of displacements with its weight; equal values change a mesh equally."""

    attribute: str
    accessor: int
    weight: float
    use: Item = field(compare=False)


class Shapes(Protocol):
    """Source of displacements: the accessors of a file, or arrays kept from them."""

    def index(self, use: Item) -> int:
        """The accessor that ``use`` names."""

    def count(self, use: Item) -> int:
        """Number of its elements."""

    def changes(
        self, use: Item, types: tuple[str, ...], what: str
    ) -> tuple[NDArray[np.int64] | slice, FloatArray]:
        """Indices of the elements that may differ from 0, and their numbers."""


class KeptShapes(Value):
    """Displacements of a primitive, kept for any weights.

    Args:
        uses: Members of its targets that name the displacements.
        accessors: Accessors of the file.
    """

    def __init__(self, uses: Iterable[Item], accessors: Accessors) -> None:
        self._known: dict[int, tuple[int, Any]] = {}
        for use in uses:
            changes = accessors.changes(use, _TYPES[str(use.key)], "displacement")
            self._known[accessors.index(use)] = accessors.count(use), changes

    def index(self, use: Item) -> int:
        """The accessor that ``use`` names."""
        return use.integer()

    def count(self, use: Item) -> int:
        """Number of its elements."""
        return self._known[self.index(use)][0]

    def changes(
        self, use: Item, types: tuple[str, ...], what: str
    ) -> tuple[NDArray[np.int64] | slice, FloatArray]:
        """Indices of the elements that may differ from 0, and their numbers."""
        places, values = self._known[self.index(use)][1]
        return places, values


def all_uses(primitive: Item) -> Iterator[Item]:
    """Yields members of targets that name displacements of the primitive's attributes."""
    attributes = primitive.need("attributes")
    for target in primitive.list_of("targets"):
        for use in target.members():
            if str(use.key) in _TYPES and attributes.get(str(use.key)) is not None:
                yield use


def weights_of(node: Item, mesh: Item) -> Item | None:
    """List of weights of a mesh at a node; None: the mesh is not morphed."""
    weights = node.get("weights")
    return mesh.get("weights") if weights is None else weights


def displacements(
    primitive: Item, weights: Item | None, shapes: Shapes, notes: Notes
) -> tuple[Displacement, ...]:
    """Finds displacements of a primitive; targets of weight 0 are skipped.

    Raises:
        InputError: The numbers of weights and targets differ.
    """
    targets = primitive.list_of("targets")
    if weights is None or not targets:
        return ()
    attributes = primitive.need("attributes")
    parts: dict[tuple[str, int], tuple[float, Item]] = {}
    for weight, target in zip(weights.numbers(len(targets)), targets, strict=True):
        for use in target.members() if weight else ():
            name = str(use.key)
            if name in _TYPES and attributes.get(name) is not None:
                # Files may name one accessor many times; it is read once.
                key = name, shapes.index(use)
                parts[key] = parts.get(key, (0.0, use))[0] + weight, use
            elif not name.startswith("_"):
                notes.add(f"morph target attribute {clean(name)[:40]!r} is not used")
    return tuple(
        Displacement(name, accessor, weight, use)
        for (name, accessor), (weight, use) in parts.items()
    )


def displacements_again(
    owner: Item, primitive: Item, shapes: KeptShapes
) -> tuple[Displacement, ...]:
    """Does the same as :func:`displacements`, with weights of a node or mesh at another time."""
    return displacements(primitive, owner.get("weights"), shapes, Silence())


def morph(arrays: dict[str, FloatArray], parts: tuple[Displacement, ...], shapes: Shapes) -> None:
    """Replaces arrays of vertices by displaced arrays; normals and tangents are not normalised.

    Args:
        arrays: Attributes of the mesh, by their names in glTF, shape (N, components).
        parts: Weighted displacements.
        shapes: Values of the displacements.
    """
    for name in dict.fromkeys(part.attribute for part in parts):
        arrays[name] = arrays[name].copy()
    for part in parts:
        array = arrays[part.attribute]
        if shapes.count(part.use) != len(array):
            part.use.fail(
                f"wrong count: wanted {len(array)} like {part.attribute} of the mesh, "
                f"got {shapes.count(part.use)}"
            )
        places, values = shapes.changes(part.use, _TYPES[part.attribute], "displacement")
        width = min(values.shape[1], array.shape[1])
        array[places, :width] += np.float32(part.weight) * values[:, :width]
    if any(part.attribute == "COLOR_0" for part in parts):
        np.clip(arrays["COLOR_0"], 0, 1, out=arrays["COLOR_0"])
