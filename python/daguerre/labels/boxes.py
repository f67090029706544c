"""3D boxes around the instances of an object, with the axes of its node."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import BriefRecord
from daguerre.scene.curves import balls_along
from daguerre.scene.parts import Curves, Mesh
from daguerre.scene.scene import Scene

FloatArray = NDArray[np.float64]
#: Centres, shape (N, 3), and radii, shape (N, 1) or (1, 1), m.
Balls = tuple[NDArray[np.floating], FloatArray]


@dataclass(frozen=True, eq=False, repr=False)
class Box3(BriefRecord):
    """An oriented box in space.

    Attributes:
        center: Centre, shape (3,), m.
        size: Edge lengths along its own axes, shape (3,), m.
        rotation: Its axes, as columns of a rotation matrix, shape (3, 3).
    """

    center: FloatArray
    size: FloatArray
    rotation: FloatArray

    def corners(self) -> FloatArray:
        """Corners, shape (8, 3), m; the last axis changes first."""
        half = np.array(list(product((-0.5, 0.5), repeat=3))) * self.size
        return np.asarray(half @ self.rotation.T + self.center)

    def seen_from(self, frame: FloatArray) -> Box3:
        """Returns the box in another frame with a rigid pose in the world, shape (4, 4)."""
        turn = frame[:3, :3]
        center = (self.center - frame[:3, 3]) @ turn
        return Box3(center, self.size, turn.T @ self.rotation)


def box_of(scene: Scene, instances: Sequence[int], used: dict[int, Balls] | None = None) -> Box3:
    """Computes the box around instances that have a surface, with the axes of the first.

    Args:
        scene: Scene; the vertices are taken at its time.
        instances: Indices of instances, at least one.
        used: Cache of the meshes' surface points, by index of the mesh.
    """
    used = {} if used is None else used
    axes = rotation_of(scene.instances[instances[0]].transform)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for instance in (scene.instances[i] for i in instances):
        mesh, world = scene.meshes[instance.mesh], instance.transform
        if instance.mesh not in used:
            used[instance.mesh] = balls_of(mesh)
        local, radii = used[instance.mesh]
        points = (local @ world[:3, :3].T + world[:3, 3]) @ axes
        if len(points):
            # A ball reaches along an axis as far as the row of the transform there is long.
            around = radii * np.linalg.norm(world[:3, :3].T @ axes, axis=0)
            low = np.minimum(low, (points - around).min(axis=0))
            high = np.maximum(high, (points + around).max(axis=0))
    return Box3(axes @ (0.5 * (low + high)), high - low, axes)


def balls_of(mesh: Mesh) -> Balls:
    """Finds the points of a mesh that have a surface around them, and its distance from each."""
    if isinstance(mesh, Curves):
        return balls_along(mesh)
    return mesh.points[np.unique(mesh.indices)], np.zeros((1, 1))


def rotation_of(world: FloatArray) -> FloatArray:
    """Rotation nearest to a matrix, without scale, shear and mirroring."""
    u, _, v = np.linalg.svd(np.asarray(world, np.float64)[:3, :3])
    turn = u @ v
    if np.linalg.det(turn) < 0:  # mirrored: flip the x axis
        turn = turn @ np.diag([-1.0, 1.0, 1.0])
    return np.asarray(turn)
