"""Pictures through maps."""

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
    Parameter("antialias", "whether to average where the map shrinks", kind="flag", default=True),
    *MOTION,
)


def how(values: Values) -> dict[str, Any]:
    """Options of a step from the values of ``FILTER``."""
    motion = {parameter.name: values[parameter.name] for parameter in MOTION}
    return {"filter": values["filter"], "antialias": values["antialias"], "motion": motion}


class WarpStep(Step):
    """Each pixel takes its light from elsewhere; what is no colour, from the nearest pixel there.

    Args:
        canvas: The picture.
        warps: One for all channels, or one each for red, green and blue.
        filter: cubic or linear.
        antialias: Whether to average where a map shrinks.
        forward: Where the light of a point of the source goes, if that is known: motion follows it.
        motion: Meaning of motion channels, in the form of ``MOTION``.
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
        """The maps for some rows."""
        return self._warps

    def reads(self, rows: Rows) -> Rows:
        """Where the maps lead."""
        parts = [warp.reads(rows) for warp in self.warps(rows)]
        return Rows(min(p.begin for p in parts), max(p.end for p in parts))

    def apply(self, band: Band, rows: Rows) -> Band:
        """All channels, so that they stay one above the other."""
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
        """Where a model had no answer, and which motion could not be turned."""
        said = []
        if self._undefined:
            said.append(
                f"{self._undefined} pixels, for which the model has no answer, were set to 0"
            )
        return said + self._motion.remarks()
