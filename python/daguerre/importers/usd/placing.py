"""Places meshes in the scene: once, or at all copies of point instancers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.motion.values import Dynamic, is_dynamic
from daguerre.motion.values import at as value_at
from daguerre.scene.over_time.operations import Matrix, Transform
from daguerre.scene.scene import Scene
from daguerre.scene.transforms import FLAT, ranks

from .instancers import Copies

Array = NDArray[np.float64]
#: Maximum number of instances of a stage.
MAX_INSTANCES = 20_000_000


@dataclass(frozen=True, eq=False)
class Spots:
    """Places of all copies of a prim: scene from the prim's parent.

    Attributes:
        still: Matrices at the scene's time, shape (N, 4, 4).
        moving: The same over time, for each copy; None: constant.
        name: Node of the copies; empty: the prim's node.
    """

    still: Array
    moving: Sequence[Dynamic] | None = None
    name: str = ""

    def __len__(self) -> int:
        return len(self.still)


def single(world: Matrix | Transform, time: float) -> Spots:
    """The place of a prim that is drawn once."""
    still = np.asarray(value_at(world, time), np.float64)[None]
    return Spots(still, [world] if isinstance(world, Transform) else None)


def times(outer: Spots, copies: Copies, inner: Matrix | Transform, name: str, time: float) -> Spots:
    """Places of the copies of an instancer that itself may be copied.

    Args:
        outer: Places of the instancer, with its transform.
        copies: Copies of a prototype.
        inner: The prototype's own transform.
        name: Node of the instancer.
        time: Scene time, s.
    """
    still = outer.still[:, None] @ copies.transforms @ value_at(inner, time)
    moving: list[Dynamic] | None = None
    if outer.moving is not None or copies.moving is not None or is_dynamic(inner):
        firsts = outer.moving if outer.moving is not None else outer.still
        crowd = copies.moving
        seconds = list(copies.transforms) if crowd is None else crowd.each()
        moving = [Transform((first, second, inner)) for first in firsts for second in seconds]
    return Spots(still.reshape(-1, 4, 4), moving, name)


class Placing:
    """Adds instances to a scene.

    Args:
        scene: The scene.
        file: File, for messages.
        notes: Receives a note on instances without extent.
    """

    def __init__(self, scene: Scene, file: str, notes: Notes) -> None:
        self._scene = scene
        self._file = file
        self._notes = notes
        self._left = MAX_INSTANCES

    def spend(self, count: int, place: str) -> None:
        """Counts instances, and stops at too many.

        Raises:
            InputError: The stage asks for more than ``MAX_INSTANCES``.
        """
        self.check(count, place)
        self._left -= count

    def check(self, count: int, place: str) -> None:
        """Checks that there is room for instances before they are made.

        Raises:
            InputError: The stage asks for more than ``MAX_INSTANCES``.
        """
        if count > self._left:
            raise InputError(
                f"{self._file}: {place}: too many instances: the limit is {MAX_INSTANCES}"
            )

    def add(self, mesh: int, material: int, spots: Spots, name: str, shown: bool | Dynamic) -> None:
        """Places a mesh.

        Args:
            mesh: Index from ``Scene.add_mesh``.
            material: Index from ``Scene.add_material``.
            spots: Places of the mesh.
            name: Node of its prim, if the places have none.
            shown: Visibility, constant or over time.
        """
        self.spend(len(spots), f"/{name}")
        scene, node, still, moving = self._scene, spots.name or name, spots.still, spots.moving
        flat = ranks(still[:, :3, :3]) < 3
        if moving is None:
            if flat.any():
                self._notes.add(f"a prim that is {FLAT} is left out", int(flat.sum()))
            still = still[~flat]
        elif flat.any():
            self._notes.add(f"a moving prim is not drawn while it is {FLAT}", int(flat.sum()))
        if shown is not True:
            motions = [None] * len(still) if moving is None else moving
            for world, motion in zip(still, motions, strict=True):
                scene.add_instance(mesh, material, world, name=node, shown=shown, motion=motion)
            return
        scene.add_instances(mesh, material, still, name=node, motions=moving)
