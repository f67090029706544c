"""Meshes with vertices at several times, as from simulations and scans."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daguerre.cached import cached_property
from daguerre.checks import array, optional_array, short, to_numbers
from daguerre.errors import InputError
from daguerre.files.value import Value
from daguerre.motion.values import Dynamic, is_dynamic, keys

from .limits import check_coordinates
from .motion import Vertices

FloatArray = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class PointCache(Value):
    """The vertices of a mesh over time.

    Attributes:
        positions: Positions over time, shape (N, 3), m.
        normals: Normals over time; None: normals of ``rest``, rotated with the surface.
        rest: Vertices of one moment, with the normals and tangents at that moment.
        triangles: Indices, shape (M, 3).
        where: Owner of the vertices, for messages.
    """

    positions: Dynamic
    normals: Dynamic | None
    rest: Vertices
    triangles: NDArray[np.uint32]
    where: str

    def at(self, time_s: float) -> Vertices:
        """Returns the vertices at a time, s."""
        count = len(self.rest.positions)
        points = optional_array(self.positions.at(time_s), self.where, "positions", 3, count)
        assert points is not None
        check_coordinates(points, self.where)
        normals, tangents, turn = self.rest.normals, self.rest.tangents, None
        if normals is not None:
            turn = _Turn(self._faces, self._smooth(points))
            normals = turn.of(normals)
        if self.normals is not None:
            given = optional_array(self.normals.at(time_s), self.where, "normals", 3, count)
            normals = _unit(given, normals)
        if turn is not None and tangents is not None:
            turned = turn.of(tangents[:, :3])
            tangents = np.concatenate([turned, tangents[:, 3:]], axis=1)
        return replace(self.rest, positions=points, normals=normals, tangents=tangents)

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Breaks of positions and normals, s."""
        both = [d for d in (self.positions, self.normals) if d is not None]
        return sorted({float(t) for d in both for t in d.breaks(begin, end)})

    @cached_property
    def _faces(self) -> NDArray[np.float64]:
        return self._smooth(self.rest.positions)

    @cached_property
    def _corners(self) -> NDArray[np.int64]:
        """Indices that merge vertices split by texture seams, shape (N,)."""
        assert self.rest.normals is not None
        rows = np.concatenate([self.rest.positions, self.rest.normals], axis=1)
        return np.asarray(np.unique(rows, axis=0, return_inverse=True)[1]).reshape(-1)

    def _smooth(self, points: FloatArray) -> NDArray[np.float64]:
        """Unit normals at the vertices, with faces weighted by area."""
        a, b, c = (points[self.triangles[:, k]].astype(np.float64) for k in range(3))
        faces = np.cross(b - a, c - a)
        sums = np.zeros((len(points), 3))
        for k in range(3):
            np.add.at(sums, self._corners[self.triangles[:, k]], faces)
        lengths = np.linalg.norm(sums, axis=1, keepdims=True)
        return np.asarray((sums / np.where(lengths > 0, lengths, 1))[self._corners])


def _unit(normals: FloatArray | None, others: FloatArray | None) -> FloatArray | None:
    """Normalizes normals between keys; those of length 0 become ``others``."""
    if normals is None:
        return None
    lengths = np.linalg.norm(normals.astype(np.float64), axis=1, keepdims=True)
    found = np.asarray(normals / np.where(lengths > 0, lengths, 1), np.float32)
    return found if others is None else np.where(lengths > 0, found, others)


class _Turn:
    """Shortest rotations from unit vectors to others, for many at once.

    Source: Moeller and Hughes 1999, Efficiently Building a Matrix to Rotate One Vector to Another.
    """

    def __init__(self, before: NDArray[np.float64], after: NDArray[np.float64]) -> None:
        self._w = np.cross(before, after)
        self._c = np.einsum("ni,ni->n", before, after)[:, None]

    def of(self, vectors: FloatArray) -> FloatArray:
        """Rotates unit vectors, float32."""
        v = vectors.astype(np.float64)
        along = np.cross(self._w, v)
        turned = self._c * v + along
        turned += (
            self._w * np.einsum("ni,ni->n", self._w, v)[:, None] / np.maximum(1 + self._c, 1e-9)
        )
        lengths = np.linalg.norm(turned, axis=1, keepdims=True)
        return np.where(lengths > 1e-9, turned / np.maximum(lengths, 1e-9), v).astype(np.float32)


def steps_of(steps: object, where: str) -> Dynamic:
    """Positions over time from the argument of ``add_mesh(steps=...)``.

    Raises:
        InputError: The argument is neither (times, positions) nor a value over time.
    """
    if is_dynamic(steps):
        value: Dynamic = steps
        return value
    if not isinstance(steps, tuple | list) or len(steps) != 2:
        raise InputError(
            f"{where}: steps: vertices per time step: wanted (times (S,), positions (S, N, 3)) or "
            f"dg.keys(...), got {short(steps)}"
        )
    times = to_numbers(steps[0], where, "steps: times", "shape (S,)")
    points = to_numbers(steps[1], where, "steps: positions", "shape (S, N, 3)")
    if times.ndim != 1 or points.ndim != 3 or points.shape[::2] != (len(times), 3):
        raise InputError(
            f"{where}: steps: wanted times (S,) and positions (S, N, 3), "
            f"got shapes {times.shape} and {points.shape}"
        )
    checked = [array(step, where, f"steps: positions[{i}]", 3) for i, step in enumerate(points)]
    try:
        return keys(zip(times.tolist(), checked, strict=True))
    except InputError as error:
        raise InputError(f"{where}: steps: {error}") from None
