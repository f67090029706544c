"""Vertices of meshes whose points move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import Value
from daguerre.motion.values import Dynamic
from daguerre.scene.motion import Vertices

from .primvars import Array
from .topology import Surface


@dataclass(frozen=True, eq=False)
class ChosenOverTime(Value):
    """Some of the points of a prim over time, such as those of the vertices of a polygon mesh.

    Attributes:
        points: Points of the prim over time, shape (P, 3).
        origins: Number of each point that is meant, shape (N,).
    """

    points: Dynamic
    origins: NDArray[np.int64]

    def at(self, time_s: float) -> Array:
        """Positions at a time, s, shape (N, 3)."""
        found: Array = np.asarray(self.points.at(time_s), np.float32)[self.origins]
        return found

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Breaks of the points, s."""
        return [float(t) for t in self.points.breaks(begin, end)]


@dataclass(frozen=True, eq=False)
class LimitOverTime(Value):
    """Vertices of a subdivision surface over time.

    Attributes:
        points: Control points over time, shape (P, 3).
        surface: The surface over them.
        origins: Vertex of the surface for each vertex of the mesh, shape (N,).
        rest: Vertices at a moment, with what does not change.
        flipped: Whether normals are those of a left-handed mesh.
    """

    points: Dynamic
    surface: Surface
    origins: NDArray[np.int64]
    rest: Vertices
    flipped: bool

    def at(self, time_s: float) -> Vertices:
        """Vertices at a time, s."""
        positions, normals = self.surface.points(np.asarray(self.points.at(time_s), np.float32))
        assert normals is not None
        turned = -normals if self.flipped else normals
        return replace(self.rest, positions=positions[self.origins], normals=turned[self.origins])

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Breaks of the points, s."""
        return [float(t) for t in self.points.breaks(begin, end)]
