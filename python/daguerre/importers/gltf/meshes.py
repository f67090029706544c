"""Reads mesh primitives of glTF as meshes of the scene, morphed and skinned for each node.

Source: glTF 2.0 specification, chapters 3.7.2 and 5.24; KHR_mesh_quantization.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.files.budget import Budget
from daguerre.files.json_item import Item, clean
from daguerre.files.notes import Notes
from daguerre.scene.limits import MAX_SIZE, largest
from daguerre.scene.scene import Scene
from daguerre.scene.skinning import Influences

from . import draco as gltf_draco
from .accessors import Accessors
from .animation import Animations, Channel
from .deforming import MeshOverTime, finished
from .morphs import (
    Displacement,
    KeptShapes,
    all_uses,
    displacements,
    displacements_again,
    morph,
    weights_of,
)
from .over_time import PartOverTime
from .skins import Skins, skin
from .triangles import triangles_of
from .variants import Variants

FloatArray = NDArray[np.float32]
_MODES = ("points", "lines", "a line loop", "a line strip", "list", "strip", "fan")
_COLORS = ("VEC3", "VEC4")
_KNOWN = ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0")
_SKINNED = ("JOINTS_", "WEIGHTS_")
# Limit of vertices times accessors of displacements.
_MAX_WORK = 1 << 30


@dataclass(frozen=True)
class Part:
    """A primitive of a mesh at a node.

    Attributes:
        mesh: Index of the mesh in the scene.
        material: Index of its material; None: the default.
        in_world: Whether a skin gave it world coordinates, so that the node's transform is ignored.
    """

    mesh: int
    material: int | None
    in_world: bool


@dataclass(frozen=True)
class _Source:
    """Sources of the vertices and triangles of a primitive."""

    primitive: Item
    mode: int
    indices: Item | None
    attributes: dict[str, Item]
    displacements: tuple[Displacement, ...]
    skin: int | None
    #: Node or mesh with the weights in effect, and the channels that change them.
    owner: Item
    moved: Sequence[Channel]
    #: Equal for weights with the same changes.
    changes: tuple[Hashable, ...]

    def key(self, accessors: Accessors) -> Hashable:
        """Key that is equal for primitives with equal vertices and triangles."""
        uses = (
            (name, accessors.index(use))
            for name, use in self.attributes.items()
            if name in _KNOWN or (self.skin is not None and name.startswith(_SKINNED))
        )
        indices = None if self.indices is None else accessors.index(self.indices)
        shape = self.mode, indices, tuple(sorted(uses))
        return *shape, self.displacements, self.skin, self.changes


class Meshes:
    """Reads primitives on demand; equal primitives share a mesh of the scene.

    Args:
        root: The JSON object of the file.
        accessors: Accessors of the file.
        animations: Animations of the file.
        skins: Skins of the file.
        variants: Chosen variant of the materials.
        scene: Receives the meshes.
        unshared: Budget of vertices that cannot be shared.
        notes: Receives notes on unsupported content.
    """

    def __init__(
        self,
        root: Item,
        accessors: Accessors,
        animations: Animations,
        skins: Skins,
        variants: Variants,
        scene: Scene,
        unshared: Budget,
        notes: Notes,
    ) -> None:
        self.items = root.list_of("meshes")
        self._variants = variants
        self._accessors = accessors
        self._animations = animations
        self._skins = skins
        self._scene = scene
        self._unshared = unshared
        self._work = Budget(_MAX_WORK, "displacements of vertices")
        self._notes = notes
        self._parts: dict[Hashable, list[Part]] = {}
        self._shared: dict[Hashable, int | None] = {}

    def parts(self, node: Item) -> list[Part]:
        """Parts of the mesh of a node."""
        index = node.need("mesh").index(len(self.items), "meshes")
        item, skin_use = self.items[index], node.get("skin")
        chosen = None if skin_use is None else self._skins.index(skin_use)
        weights = weights_of(node, item)
        shape = None if weights is None else tuple(w.number() for w in weights)
        holder = item if node.get("weights") is None else node
        owners = "meshes" if holder is item else "nodes"
        found = self._animations.of(owners, str(holder.key))
        moved = [c for c in found if "weights" in c.tokens]
        changes = tuple((id(c.track), *c.tokens[2:]) for c in moved)
        key = index, shape, chosen, changes
        if key not in self._parts:
            primitives = list(item.need("primitives"))
            name = item.name() or f"mesh{index}"
            self._parts[key] = []
            for primitive in primitives:
                full = name if len(primitives) == 1 else f"{name}/{primitive.key}"
                source = self._source(primitive, chosen, holder, moved, changes)
                part = None if source is None else self._part(source, full)
                if part is not None:
                    self._parts[key].append(part)
        return self._parts[key]

    def _part(self, source: _Source, name: str) -> Part | None:
        key = source.key(self._accessors)
        if key not in self._shared:
            self._shared[key] = self._read(source, name)
        mesh = self._shared[key]
        if mesh is None:
            return None
        return Part(mesh, self._variants.material(source.primitive), source.skin is not None)

    def _source(
        self,
        primitive: Item,
        chosen: int | None,
        owner: Item,
        moved: Sequence[Channel],
        changes: tuple[Hashable, ...],
    ) -> _Source | None:
        mode_item = primitive.get("mode")
        mode = 4 if mode_item is None else mode_item.choice(range(7))
        attributes = {str(item.key): item for item in primitive.need("attributes").members()}
        if mode < 4:
            self._notes.add(f"a mesh primitive of {_MODES[mode]} is left out")
            return None
        if "POSITION" not in attributes:
            self._notes.add("a mesh primitive without POSITION is left out")
            return None
        if chosen is not None and "JOINTS_0" not in attributes:
            self._notes.add("a mesh without JOINTS_0 is not moved by its skin")
            chosen = None
        if chosen is not None and self._is_nothing(chosen):
            # Scale 0 hides an object, as at a node (3.5.3).
            self._notes.add("a mesh that its skin scales to zero is left out")
            return None
        if gltf_draco.supply(primitive, mode, attributes, self._accessors, self._notes):
            mode = 4
        indices, weights = primitive.get("indices"), owner.get("weights")
        displaced = displacements(primitive, weights, self._accessors, self._notes)
        return _Source(
            primitive, mode, indices, attributes, displaced, chosen, owner, moved, changes
        )

    def _is_nothing(self, skin: int) -> bool:
        return not self._skins.moves(skin) and not self._skins.matrices(skin)[:, :3, :3].any()

    def _read(self, source: _Source, name: str) -> int | None:
        attributes = source.attributes
        self._note_unknown(attributes)
        count = self._accessors.count(attributes["POSITION"])
        arrays = {
            key: self._attribute(attributes[key], count) for key in _KNOWN if key in attributes
        }
        triangles = triangles_of(
            source.primitive, source.indices, source.mode, count, self._accessors
        )
        if not len(triangles):
            self._notes.add("a mesh primitive whose triangles all have zero area is left out")
            return None
        base = dict(arrays)
        triangles, influences = self._deform(source, arrays, triangles)
        positions = arrays["POSITION"]
        # This also catches NaN.
        if not largest(positions) < MAX_SIZE:
            far = np.flatnonzero(~(np.abs(positions) < MAX_SIZE).all(axis=1))
            attributes["POSITION"].fail(
                f"vertex {far[0]}: wanted coordinates below {MAX_SIZE:g}, "
                f"got {positions[far[0]].tolist()}"
            )
        moves = bool(source.changes)
        moves = moves or (source.skin is not None and self._skins.moves(source.skin))
        made = finished(arrays, base if moves else {}, triangles, self._notes)
        over = self._over_time(source, base, triangles, influences) if moves else None
        return self._scene.add_mesh(
            indices=freeze_in_place(triangles),
            motion=over,
            name=name,
            **{
                key: cast("Any", freeze_in_place(v))
                for key, v in vars(made).items()
                if v is not None
            },
        )

    def _over_time(
        self,
        source: _Source,
        base: dict[str, FloatArray],
        triangles: NDArray[np.uint32],
        influences: Influences | None,
    ) -> MeshOverTime:
        needed = [part.use for part in source.displacements]
        uses = all_uses(source.primitive) if source.moved else needed
        shapes = KeptShapes(uses, self._accessors)
        again = partial(displacements_again, primitive=source.primitive, shapes=shapes)
        weights = PartOverTime(source.owner, source.moved, again)
        skin_of = None
        if source.skin is not None and influences is not None:
            skin_of = self._skins.over_time(source.skin, influences)
        return MeshOverTime(base, triangles, weights, shapes, skin_of)

    def _deform(
        self, source: _Source, arrays: dict[str, FloatArray], triangles: NDArray[np.uint32]
    ) -> tuple[NDArray[np.uint32], Influences | None]:
        """Morphs, then skins (3.7.2.2); returns triangles wound for the new vertices."""
        count = len(arrays["POSITION"])
        if source.displacements:
            self._unshared.spend(count, source.primitive)
            self._work.spend(count * len(source.displacements), source.primitive)
            morph(arrays, source.displacements, self._accessors)
        if source.skin is None:
            return triangles, None
        sets = sum(name.startswith("JOINTS_") for name in source.attributes)
        self._unshared.spend(count * sets, source.primitive)
        found = self._skins.influences(source.attributes, source.skin, count)
        mirrored = skin(arrays, found, self._skins.matrices(source.skin))
        return np.where(mirrored[triangles[:, :1]], triangles[:, ::-1], triangles), found

    def _note_unknown(self, attributes: dict[str, Item]) -> None:
        for key in attributes:
            # Names with an underscore belong to applications (3.7.2.1); skins have been read.
            if key not in _KNOWN and not key.startswith(("_", *_SKINNED)):
                self._notes.add(f"mesh attribute {clean(key)[:40]!r} is not used")

    def _attribute(self, use: Item, count: int) -> FloatArray:
        vec3 = ("VEC3",)
        types = {"POSITION": vec3, "NORMAL": vec3, "TANGENT": ("VEC4",), "COLOR_0": _COLORS}
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
