"""Places meshes in the world: an instance for each part of a mesh and each transform.

Source: glTF 2.0 specification, chapters 3.5.3 (scale 0) and 3.7.4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from daguerre.files.budget import Budget
from daguerre.files.json_item import Item
from daguerre.files.notes import Notes
from daguerre.scene.limits import MAX_SIZE, largest
from daguerre.scene.materials import Gltf, Material
from daguerre.scene.parts import vertices_of
from daguerre.scene.scene import Scene
from daguerre.scene.transforms import ranks

from .instancing import MAX_INSTANCES
from .over_time import FlatOverTime, NodeOverTime, ShownOverTime

Matrices = NDArray[np.float64]


@dataclass(frozen=True)
class Motion:
    """Motion of an instance; None: constant.

    Attributes:
        transform: World from mesh.
        shown: Visibility.
        flat: Transform that may be singular, instead of ``transform``.
    """

    transform: NodeOverTime | None = None
    shown: ShownOverTime | None = None
    flat: NodeOverTime | None = None


class Placing:
    """Adds instances to a scene.

    Args:
        scene: Scene with meshes and materials.
        unshared: Budget of vertices that cannot be shared.
        notes: Receives notes on unsupported content.
    """

    def __init__(self, scene: Scene, unshared: Budget, notes: Notes) -> None:
        self._scene = scene
        self._unshared = unshared
        self._instances = Budget(MAX_INSTANCES, "instances in a scene")
        self._notes = notes
        self._default_material: int | None = None

    def add(
        self,
        node: Item,
        mesh: int,
        material: int | None,
        worlds: Matrices,
        name: str,
        moves: Sequence[Motion] | None = None,
    ) -> None:
        """Adds instances of a mesh.

        Args:
            node: Node of the file, for messages.
            mesh: Index of the scene's mesh.
            material: Index of the material; None: glTF's default.
            worlds: World from mesh, shape (instances, 4, 4).
            name: Name of the instances.
            moves: Motion of each instance; None: no motion.
        """
        scene = self._scene
        self._instances.spend(len(worlds), node)
        size = largest(worlds)
        if not size < MAX_SIZE:  # NaN is not smaller than anything
            node.fail(f"world transform: wanted numbers below {MAX_SIZE:g}, got {size:g}")
        if material is None:
            material = self._default()
        self._note_missing_uv(mesh, material)
        dimensions = ranks(worlds[:, :3, :3])
        hidden = int((dimensions < 2).sum()) if moves is None else 0
        if hidden:  # scale 0 is how files hide things
            self._notes.add("a mesh that its node scales to zero is left out", hidden)
        if moves is not None:
            for world, motion in zip(worlds, moves, strict=True):
                self._add_moving(node, mesh, material, world, name, motion)
            return
        for rank, run in groupby(range(len(worlds)), dimensions.tolist().__getitem__):
            if rank == 3:
                scene.add_instances(mesh, material, worlds[list(run)], name=name)
            for k in run if rank == 2 else ():
                self._unshared.spend(len(scene.meshes[mesh].positions), node)
                scene.add_instance(self._flattened(mesh, worlds[k], name), material, name=name)

    def _add_moving(
        self, node: Item, mesh: int, material: int, world: Matrices, name: str, motion: Motion
    ) -> None:
        if motion.flat is not None:
            vertices = vertices_of(self._scene.meshes[mesh])
            self._unshared.spend(len(vertices.positions), node)
            rest = replace(vertices, normals=None, tangents=None)
            mesh = self._flattened(mesh, world, name, FlatOverTime(motion.flat, rest))
            world = np.eye(4)
        shown = True if motion.shown is None else motion.shown
        self._scene.add_instance(
            mesh, material, world, name=name, shown=shown, motion=motion.transform
        )

    def _default(self) -> int:
        if self._default_material is None:
            self._default_material = self._scene.add_material(Material(Gltf(), name="default"))
        return self._default_material

    def _flattened(
        self, mesh: int, world: Matrices, name: str, motion: FlatOverTime | None = None
    ) -> int:
        """Adds a mesh with vertices in the world, as a flat transform has no inverse."""
        flat = self._scene.meshes[mesh]
        points = flat.positions @ world[:3, :3].T + world[:3, 3]
        return self._scene.add_mesh(
            points,
            flat.indices,
            uv=flat.uv,
            uv1=flat.uv1,
            colors=flat.colors,
            motion=motion,
            name=name,
        )

    def _note_missing_uv(self, mesh: int, material: int) -> None:
        kind = self._scene.materials[material].kind
        arrays = (self._scene.meshes[mesh].uv, self._scene.meshes[mesh].uv1)
        for key, slot in vars(kind).items():
            if key.endswith("_texture") and slot is not None and arrays[slot.uv_set] is None:
                self._notes.add("a textured mesh lacks the texture coordinates that it needs")
                return
