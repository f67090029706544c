"""Places meshes in the scene: shapes once, shapes of objects at each instance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daguerre.files.json_item import clean
from daguerre.motion.values import Keys
from daguerre.scene.scene import Scene
from daguerre.scene.transforms import FLAT, ranks

from .ledger import Ledger
from .place import FilePlace
from .transforms import Matrix, Moving

#: Maximum number of instances of a scene.
MAX_INSTANCES = 20_000_000


@dataclass(frozen=True, eq=False)
class Spots:
    """Places of the copies of a shape.

    Attributes:
        name: Node of the copies.
        outer: Transforms of the instances of its object; a single identity outside of objects.
        place: Place of the directive, for messages.
    """

    name: str
    outer: Sequence[Moving]
    place: FilePlace


class Placing:
    """Adds instances to a scene.

    Args:
        scene: The scene.
        axes: Scene from world of pbrt, shape (4, 4).
        ledger: Receives notes.
    """

    def __init__(self, scene: Scene, axes: Matrix, ledger: Ledger) -> None:
        self._scene, self._axes, self._ledger = scene, axes, ledger
        self._left = MAX_INSTANCES
        self._taken: dict[str, int] = {}

    def name(self, wanted: str) -> str:
        """Returns a name that no other node has."""
        base = clean(wanted) or "shape"
        self._taken[base] = count = self._taken.get(base, 0) + 1
        return base if count == 1 else self.name(f"{base} {count}")

    def add(self, mesh: int, material: int, inner: Moving, spots: Spots) -> None:
        """Places a mesh.

        Args:
            mesh: Index of the mesh.
            material: Index of its material.
            inner: Transform of the shape in its object, or in the world.
            spots: Places of the mesh.

        Raises:
            InputError: There are too many instances.
        """
        self._left -= len(spots.outer)
        if self._left < 0:
            spots.place.fail(f"too many instances: the limit is {MAX_INSTANCES}")
        values = [self._in_scene(inner.after(outer)).value() for outer in spots.outer]
        still = np.array([self._now(value) for value in values], np.float64).reshape(-1, 4, 4)
        moves = np.array([isinstance(value, Keys) for value in values], bool)
        lost = (ranks(still[:, :3, :3]) < 3) & ~moves
        if lost.any():
            self._ledger.notes.add(f"a shape that is {FLAT} is left out", int(lost.sum()))
            still = still[~lost]
        if not len(still):
            return
        if spots.name not in self._scene.node_positions:
            self._scene.add_node(spots.name, still[0, :3, 3].copy())
        if not moves.any():
            self._scene.add_instances(mesh, material, still, name=spots.name)
            return
        drawn = [value for value, gone in zip(values, lost, strict=True) if not gone]
        for world, value in zip(still, drawn, strict=True):
            motion = value if isinstance(value, Keys) else None
            if motion and (ranks(np.array(motion.values)[:, :3, :3]) < 3).any():
                self._ledger.notes.add(f"a moving shape is not drawn while it is {FLAT}")
            self._scene.add_instance(mesh, material, world, name=spots.name, motion=motion)

    def _in_scene(self, moving: Moving) -> Moving:
        start = self._axes @ moving.start
        end = start if moving.end is moving.start else self._axes @ moving.end
        return Moving(start, end, moving.times)

    def _now(self, value: Matrix | Keys) -> Matrix:
        now = value.at(self._scene.time) if isinstance(value, Keys) else value
        return np.asarray(now, np.float64)
