"""Maps motion vectors when a picture is warped.

A pixel of the result shows the source at s, with motion m to s + m. Its mapped motion leads to the
position of s + m in the result. If only the map from result to source is known (an STMap), its
derivative transforms motion, to first order.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.cached import cached_property
from daguerre.convolution.rows import Rows

from .channels import BACK, PARTS, USUAL
from .parameter import Parameter
from .picture import Canvas
from .warp import CELL, FloatArray, PointMap, Warp, displacements

MOTION = (
    Parameter("motion_scale", "px per unit of motion; -1: motion from the previous frame", "", 1.0),
    Parameter("v_up", "whether v is positive upward, not downward", kind="flag", default=False),
)
CHUNK = 1 << 20  # points at a time


class MotionMap:
    """Transforms the motion channels of a picture by a map."""

    def __init__(
        self, canvas: Canvas, forward: PointMap | None, values: Mapping[str, Any] = {}
    ) -> None:
        """Finds the channels.

        Args:
            canvas: Facts about the picture.
            forward: Map from points of the source to the result, px; None: unknown.
            values: Values of the parameters ``MOTION``, all or some.
        """
        self.pairs, self.single = _pairs(canvas)
        self._canvas, self._forward = canvas, forward
        scale = values.get("motion_scale", 1.0)
        self._scale = np.array([scale, -scale if values.get("v_up") else scale])
        self._lost = 0

    def turned(
        self, planes: Mapping[str, NDArray[Any]], warp: Warp, rows: Rows
    ) -> dict[str, NDArray[Any]]:
        """Transforms the motion of rows of the result; their pixels are already moved."""
        if not self.pairs:
            return {}
        moved = warp.core.displacements(self._canvas.width, *rows)
        out: dict[str, NDArray[Any]] = {}
        for pair in self.pairs:
            motion = np.stack([np.asarray(planes[name], np.float64) for name in pair], axis=2)
            with np.errstate(invalid="ignore"):
                goes = np.isfinite(motion).all(axis=2) & (motion != 0).any(axis=2)
            turn = self._by_derivative if self._forward is None else self._by_ends
            found = turn(motion[goes] * self._scale, moved, goes, rows) / self._scale
            self._lost += int((~np.isfinite(found)).any(axis=1).sum())
            motion[goes] = found
            for k, name in enumerate(pair):
                out[name] = motion[:, :, k].astype(planes[name].dtype)
        return out

    def remarks(self) -> list[str]:
        """Notes on motion vectors that could not be transformed."""
        said = []
        if self._lost:
            said.append(
                f"{self._lost} motion vectors that end outside the map's result are set to NaN"
            )
        if self.single:
            said.append(
                f"{', '.join(self.single)}: the other coordinate is missing, so the values are "
                "moved with the pixels, but not transformed"
            )
        return said

    def _by_ends(
        self, motion: FloatArray, moved: NDArray[np.float32], goes: NDArray[np.bool_], rows: Rows
    ) -> FloatArray:
        """Computes m + d(s + m) - d(s); common errors of the displacement d cancel."""
        y, x = np.nonzero(goes)
        start = np.column_stack([x, y + rows.begin]).astype(np.float64) + moved[goes]
        out = np.empty_like(motion)
        for k in range(0, len(start), CHUNK):
            s, m = start[k : k + CHUNK], motion[k : k + CHUNK]
            out[k : k + CHUNK] = m + self._displaced(s + m) - self._displaced(s)
        return out

    @cached_property
    def _warp(self) -> Warp:
        assert self._forward is not None
        return Warp.of(self._canvas, self._forward)

    def _displaced(self, points: FloatArray) -> FloatArray:
        """Displacement of source points by the map, also outside the picture."""
        assert self._forward is not None
        out = np.asarray(self._warp.core.displacements_at(points), np.float64)
        rest = np.isnan(out).any(axis=1)
        if rest.any():
            out[rest] = displacements(points[rest], self._canvas, self._forward)
        return out

    def _by_derivative(
        self, motion: FloatArray, moved: NDArray[np.float32], goes: NDArray[np.bool_], rows: Rows
    ) -> FloatArray:
        """Transforms motion by the inverse derivative of the map from result to source."""
        across, down = (_difference(moved, axis)[goes].astype(np.float64) for axis in (1, 0))
        a, c = across[:, 0] + 1, across[:, 1]
        b, d = down[:, 0], down[:, 1] + 1
        with np.errstate(invalid="ignore", divide="ignore"):
            u = (d * motion[:, 0] - b * motion[:, 1]) / (a * d - b * c)
            v = (a * motion[:, 1] - c * motion[:, 0]) / (a * d - b * c)
        return np.column_stack([u, v])


def _pairs(canvas: Canvas) -> tuple[list[tuple[str, str]], list[str]]:
    """Pairs of channels that hold a motion, and channels without their other coordinate."""
    names = {name.lower(): name for name in canvas.planes}
    wanted: list[Sequence[str]] = list(zip(*(USUAL[role] for role in PARTS["motion"]), strict=True))
    given = [canvas.roles.get(role) for role in PARTS["motion"]]
    if all(given):
        wanted.insert(0, [str(name) for name in given])
    found: dict[str, tuple[str, str]] = {}
    single = []
    for u, v in (*wanted, BACK):
        have = [names[name.lower()] for name in (u, v) if name.lower() in names]
        if len(have) == 2:
            found.setdefault(have[0], (have[0], have[1]))
        single += have if len(have) == 1 else []
    return list(found.values()), single


def _difference(values: NDArray[np.float32], axis: int) -> NDArray[np.float32]:
    """Differences between pixels within each cell, so that they do not depend on other bands."""
    count = values.shape[axis]
    at = np.arange(count)
    first = np.minimum(at - (at % CELL == CELL - 1), max(count - 2, 0))
    after = np.minimum(first + 1, count - 1)
    return np.asarray(np.take(values, after, axis) - np.take(values, first, axis))
