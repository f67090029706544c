"""Places meshes in the world, all copies of one mesh together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.motion.values import Keys, keys
from daguerre.scene.scene import Scene
from daguerre.scene.transforms import ranks

Matrix = NDArray[np.float64]
#: Pairs (time in s, matrix).
Path = Sequence[tuple[float, Matrix]]


@dataclass
class _Copies:
    """Places of a mesh with the same material and name, at rest and moving."""

    still: list[Matrix] = field(default_factory=list)
    moving: list[Keys] = field(default_factory=list)


class Placing:
    """Collects the places of meshes, and adds them to a scene.

    Args:
        scene: Receives the instances.
        notes: Receives a note on instances without extent.
    """

    def __init__(self, scene: Scene, notes: Notes) -> None:
        self._scene = scene
        self._notes = notes
        self._copies: dict[tuple[int, int, str], _Copies] = {}

    def add(
        self, parts: Sequence[tuple[int, int]], name: str, world: Matrix, path: Path | None
    ) -> None:
        """Places the parts of a mesh.

        Args:
            parts: Pairs (mesh, material).
            name: Name of its node.
            world: World from mesh, shape (4, 4).
            path: The same over time; None: it rests.
        """
        moving = None if path is None else keys(path)
        for mesh, material in parts:
            copies = self._copies.setdefault((mesh, material, name), _Copies())
            if moving is None:
                copies.still.append(world)
            else:
                copies.moving.append(moving)

    def finish(self) -> None:
        """Adds all of them to the scene."""
        for (mesh, material, name), copies in self._copies.items():
            still, moving = self._solid(copies)
            if len(still):
                self._scene.add_instances(mesh, material, still, name=name)
            if moving:
                now = np.array([one.at(self._scene.time) for one in moving])
                self._scene.add_instances(mesh, material, now, name=name, motions=moving)

    def _solid(self, copies: _Copies) -> tuple[Matrix, list[Keys]]:
        """Those that are not scaled to nothing."""
        still = np.array(copies.still).reshape(-1, 4, 4)
        solid = ranks(still[:, :3, :3]) == 3
        moving = [one for one in copies.moving if _is_solid(one)]
        flat = int((~solid).sum()) + len(copies.moving) - len(moving)
        if flat:
            self._notes.add("an object with a scale of 0 is left out", flat)
        return still[solid], moving


def _is_solid(path: Keys) -> bool:
    return bool((ranks(np.array(path.values)[:, :3, :3]) == 3).all())
