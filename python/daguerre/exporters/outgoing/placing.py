"""Placements of meshes: groups that share a mesh, and single placements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.scene.parts import Curves, Mesh
from daguerre.scene.scene import Scene


@dataclass(frozen=True)
class Placed:
    """A mesh with a material, and where it stands.

    Attributes:
        mesh: Index of the mesh.
        material: Index of the material.
        transforms: World from the positions of the mesh, shape (N, 4, 4).
    """

    mesh: int
    material: int
    transforms: NDArray[np.float64]


def placements(scene: Scene, notes: Notes) -> Iterator[Placed]:
    """Yields visible meshes by mesh and material, in the order of their first instance."""
    found: dict[tuple[int, int], list[NDArray[np.float64]]] = {}
    for instance in scene.instances:
        if not instance.shown:
            continue
        if instance.catcher is not None:
            notes.add("catcher is left out")
        elif isinstance(scene.meshes[instance.mesh], Curves):
            notes.add("curves are left out")
        elif not len(scene.meshes[instance.mesh].indices):
            continue
        else:
            key = instance.mesh, instance.material
            found.setdefault(key, []).append(instance.transform)
    for (mesh, material), transforms in found.items():
        yield Placed(mesh, material, np.stack(transforms) @ _from_positions(scene.meshes[mesh]))


def _from_positions(mesh: Mesh) -> NDArray[np.float64]:
    """Space of a mesh from its positions, which may have an origin of their own, (4, 4)."""
    matrix = np.eye(4)
    matrix[:3, 3] = mesh.origin
    return matrix


def mirrored(transform: NDArray[np.float64]) -> bool:
    """Whether a transform turns a mesh into its mirror image."""
    return bool(np.linalg.det(transform[:3, :3]) < 0)
