"""Warps pictures by maps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre._core import remap, remap_nearest
from daguerre.convolution.rows import Rows

from .effect import Step, Values
from .motion_map import MOTION, MotionMap
from .parameter import Parameter
from .picture import Band, Canvas
from .warp import PointMap, Warp

FILTER = (
    Parameter(
        "filter",
        "interpolation between pixels",
        kind="choice",
        default="cubic",
        choices=("cubic", "linear"),
    ),
    Parameter(
        "antialias",
        "whether to average where the map shrinks the picture",
        kind="flag",
        default=True,
    ),
    *MOTION,
)


def how(values: Values) -> dict[str, Any]:
    """Options of a step from the values of ``FILTER``."""
    motion = {parameter.name: values[parameter.name] for parameter in MOTION}
    return {"filter": values["filter"], "antialias": values["antialias"], "motion": motion}


class WarpStep(Step):
    """Warps colours by interpolation, and all other channels by the nearest pixel.

    Args:
        canvas: Facts about the picture.
        warps: One map for all channels, or one each for red, green and blue.
        filter: Interpolation: ``cubic`` or ``linear``.
        antialias: Whether to average where a map shrinks the picture.
        forward: Map from points of the source to the result, for motion channels; None: unknown.
        motion: Values of the parameters ``MOTION``, which define motion channels.
    """

    def __init__(
        self,
        canvas: Canvas,
        warps: Sequence[Warp],
        *,
        filter: str,
        antialias: bool,
        forward: PointMap | None = None,
        motion: Mapping[str, Any] = {},
    ) -> None:
        self._height, self._warps = canvas.height, list(warps)
        self._filter, self._antialias = filter, antialias
        middle = len(self._warps) // 2
        count = len(canvas.colors)
        self._map_of = [middle] * count
        if len(self._warps) == 3 and count >= 3:
            self._map_of[:3] = [0, 1, 2]
        self._undefined = 0
        self._motion = MotionMap(canvas, forward, motion)

    def warps(self, rows: Rows) -> Sequence[Warp]:
        """Returns the maps for some rows."""
        return self._warps

    def reads(self, rows: Rows) -> Rows:
        """Returns the source rows that the maps need."""
        parts = [warp.reads(rows) for warp in self.warps(rows)]
        return Rows(min(p.begin for p in parts), max(p.end for p in parts))

    def apply(self, band: Band, rows: Rows) -> Band:
        """Warps all channels alike, so that they stay aligned."""
        warps = self.warps(rows)
        maps, middle = [warp.core for warp in warps], warps[len(warps) // 2]
        image, undefined = remap(
            band.image, band.rows.begin, self._height, maps, self._map_of, rows,
            self._filter, self._antialias,
        )  # fmt: skip
        self._undefined += undefined
        planes = {
            name: self._nearest(p, band, rows, middle.core) for name, p in band.planes.items()
        }
        return Band(rows, image, planes | self._motion.turned(planes, middle, rows))

    def _nearest(self, plane: NDArray[Any], band: Band, rows: Rows, core: Any) -> NDArray[Any]:
        words = plane.astype(np.float32) if plane.dtype == np.float16 else plane
        bits = np.ascontiguousarray(words).view(np.uint32)
        moved = remap_nearest(bits, band.rows.begin, self._height, core, *rows)
        return np.asarray(moved.view(words.dtype).astype(plane.dtype, copy=False))

    def remarks(self) -> list[str]:
        """Notes on pixels where the model is not defined, and on motion that was not mapped."""
        said = []
        if self._undefined:
            said.append(
                f"{self._undefined} pixels where the distortion model is not defined are set to 0"
            )
        return said + self._motion.remarks()
