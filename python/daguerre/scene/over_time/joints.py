"""Joints over time, and points that follow them.

USD interpolates translations, rotations and scales of joints between time samples, then multiplies
them along the skeleton. Skinned points are in the space of the skeleton.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import Value
from daguerre.motion.values import Dynamic, is_dynamic
from daguerre.motion.values import at as value_at
from daguerre.scene.skinning import Influences, blended
from daguerre.scene.transforms import compose

from .quaternions import normalized
from .shapes import BlendShapes

Array = NDArray[np.float32]
Matrices = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class JointPoses(Value):
    """The joints of a skeleton, over time or at rest.

    Attributes:
        translations: Places of the animated joints, shape (A, 3), constant or over time.
        rotations: Their quaternions x, y, z, w, shape (A, 4), constant or over time.
        scales: Their scales, shape (A, 3), constant or over time.
        animated: Index in the skeleton of each animated joint, shape (A,).
        rest: Local transform of each joint where it is not animated, shape (J, 4, 4).
        parents: Parent of each joint, or -1; parents come first.
        inverse_bind: Joint from skeleton in the bind pose, shape (J, 4, 4).
    """

    translations: NDArray[np.floating] | Dynamic
    rotations: NDArray[np.floating] | Dynamic
    scales: NDArray[np.floating] | Dynamic
    animated: NDArray[np.int64]
    rest: Matrices
    parents: NDArray[np.int64]
    inverse_bind: Matrices

    def at(self, time_s: float) -> Matrices:
        """Skeleton from bind pose for each joint at a time, s, shape (J, 4, 4)."""
        local = self.rest.copy()
        if len(self.animated):
            parts = (value_at(part, time_s) for part in (self.translations, self.scales))
            places, scales = (np.asarray(part, np.float64) for part in parts)
            turns = np.asarray(value_at(self.rotations, time_s), np.float64)
            local[self.animated] = compose(places, normalized(turns), scales)
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                local[joint] = local[parent] @ local[joint]
        made: Matrices = local @ self.inverse_bind
        return made

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of all keys, s."""
        parts = (self.translations, self.rotations, self.scales)
        moving = [part for part in parts if is_dynamic(part)]
        return sorted({float(t) for part in moving for t in part.breaks(begin, end)})

    @property
    def moves(self) -> bool:
        """Whether a joint moves."""
        return any(map(is_dynamic, (self.translations, self.rotations, self.scales)))


@dataclass(frozen=True, eq=False)
class Skinned(Value):
    """Points that follow joints, in the space of the skeleton.

    Attributes:
        points: Points of the mesh, constant or over time.
        shapes: Blend shapes that shift the points first, or None.
        joints: The joints, or None.
        influences: Joints and weights of the points.
        bind: Skeleton from mesh in the bind pose, shape (4, 4).
    """

    points: Array | Dynamic
    shapes: BlendShapes | None
    joints: JointPoses | None
    influences: Influences
    bind: Matrices

    def at(self, time_s: float) -> Array:
        """The points at a time, s, shape (N, 3)."""
        points = np.asarray(value_at(self.points, time_s), np.float32)
        if self.shapes is not None:
            points = self.shapes.shifted(points, time_s)
        if self.joints is None:
            return points
        matrices = self.joints.at(time_s) @ self.bind
        made = np.empty_like(points)
        for piece, blend in blended(self.influences, matrices, len(points)):
            turned = np.einsum("nij,nj->ni", blend[:, :, :3], points[piece])
            made[piece] = turned + blend[:, :, 3]
        return made

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of all keys, s."""
        parts: tuple[Any, ...] = (self.points, self.shapes, self.joints)
        moving = [part for part in parts if is_dynamic(part)]
        return sorted({float(t) for part in moving for t in part.breaks(begin, end)})

    @property
    def moves(self) -> bool:
        """Whether a point moves."""
        joints = self.joints is not None and self.joints.moves
        shapes = self.shapes is not None and is_dynamic(self.shapes.weights)
        return joints or shapes or is_dynamic(self.points)
