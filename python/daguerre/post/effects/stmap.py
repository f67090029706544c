"""STMaps: the source position of each pixel, as Nuke and other programs exchange it.

Red is s, from 0 at the left edge of the source to 1 at its right edge; green is t, from 0 at the
bottom edge to 1 at the top edge. These are edges, not pixel centres, so the identity map has
s = (column + 0.5) / width and t = 1 - (row + 0.5) / height, rows counted from the top.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import MAX_RESOLUTION, number, numbers, to_numbers
from daguerre.convolution.rows import Rows
from daguerre.distortion import Distortion
from daguerre.errors import InputError, UsageError
from daguerre.pictures.exr.reader import ExrReader
from daguerre.post.array import step_on_array
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.parameter import REQUIRED, Parameter
from daguerre.post.picture import Canvas, Image
from daguerre.post.stmap_rows import st_rows
from daguerre.post.warp import CELL, Warp
from daguerre.post.warp_step import FILTER, WarpStep, how

from .distortion import pair_px, point_map


class _FileStep(WarpStep):
    """Step that reads the map band by band."""

    def __init__(self, canvas: Canvas, reader: ExrReader, **how: Any) -> None:
        super().__init__(canvas, [], **how)
        self._canvas, self._reader = canvas, reader
        self._last: tuple[Rows, Warp] | None = None

    def warps(self, rows: Rows) -> list[Warp]:
        """Reads the map in whole cells, so that no row depends on how the picture is cut."""
        if self._last is None or self._last[0] != rows:
            top = rows.begin // CELL * CELL
            end = min(-(-rows.end // CELL) * CELL, self._canvas.height)
            st = self._read(Rows(top, end))
            moved = _displacements(st, self._canvas, Rows(top, end))
            self._last = rows, Warp.of_pixels(moved, self._canvas.height, top)
        return [self._last[1]]

    def _read(self, rows: Rows) -> Image:
        """Returns s and t for rows of the picture; NaN where the map has no pixels."""
        canvas, reader = self._canvas, self._reader
        st = np.full((rows.end - rows.begin, canvas.width, 2), np.nan, np.float32)
        down = canvas.corner[1] - (reader.corner[1] - reader.full_corner[1])
        right = canvas.corner[0] - (reader.corner[0] - reader.full_corner[0])
        y0, y1 = max(rows.begin + down, 0), min(rows.end + down, reader.height)
        x0, x1 = max(right, 0), min(canvas.width + right, reader.width)
        if y0 < y1 and x0 < x1:
            found = reader.rows(y0, y1)
            to = st[y0 - down - rows.begin : y1 - down - rows.begin, x0 - right : x1 - right]
            to[:] = np.stack([found["R"][:, x0:x1], found["G"][:, x0:x1]], axis=2)
        return st


def _displacements(st: Image, canvas: Canvas, rows: Rows) -> NDArray[np.float32]:
    """Displacements, px; NaN far outside, so that no number overflows."""
    width, height = canvas.full_size
    x = st[:, :, 0].astype(np.float64) * width - (np.arange(canvas.width) + canvas.corner[0] + 0.5)
    row = np.arange(rows.begin, rows.end) + canvas.corner[1] + 0.5
    y = (1 - st[:, :, 1].astype(np.float64)) * height - row[:, None]
    moved = np.stack([x, y], axis=2)
    return np.where(np.abs(moved) < 1e6, moved, np.nan).astype(np.float32)


def _make(canvas: Canvas, values: Values) -> Step:
    reader = ExrReader(values["file"])
    if not {"R", "G"} <= set(reader.channels):
        have = ", ".join(list(reader.channels)[:24])
        raise InputError(f"{reader.path}: channels: wanted R and G (s and t), got {have}")
    if reader.full_size != canvas.full_size:
        wanted, got = ("{} x {}".format(*size) for size in (canvas.full_size, reader.full_size))
        raise InputError(f"{reader.path}: display window: wanted {wanted} pixels, got {got}")
    return _FileStep(canvas, reader, **how(values))


STMAP = Effect(
    "stmap",
    "warp by an STMap: R is s from the left, G is t from the bottom",
    (Parameter("file", "path of the STMap, an .exr", kind="file", default=REQUIRED), *FILTER),
    _make,
)


@guarded(arrays=False)
def stmap(
    model: Distortion,
    size: tuple[int, int],
    *,
    focal_px: float | tuple[float, float],
    centre: tuple[float, float] | None = None,
    scale: float = 1.0,
    inverse: bool = False,
) -> Image:
    """Returns the STMap of a distortion; see :func:`daguerre.post.distort`.

    Args:
        model: Distortion model.
        size: Width and height of the picture, px.
        focal_px: Focal length, px; a number, or horizontal and vertical.
        centre: Centre of the distortion, px; default: the middle.
        scale: Magnification of the ideal picture.
        inverse: Whether the map undistorts instead.

    Returns:
        s and t, shape (H, W, 2); NaN where the model is not defined.
    """
    for side in numbers(size, "stmap: size", 2, "width and height in px"):
        number(side, "stmap: size", 1, MAX_RESOLUTION)
    size = int(size[0]), int(size[1])
    canvas = Canvas(*size)
    focal = pair_px(focal_px)
    middle = canvas.center if centre is None else centre
    warp = Warp.of(canvas, point_map(model, focal, middle, scale=scale, inverse=inverse))
    return st_rows(warp, canvas, Rows(0, canvas.height))


@guarded(arrays=False)
def apply_stmap(image: Image, st: Image, *, filter: str = "cubic", antialias: bool = True) -> Image:
    """Warps a picture by an STMap.

    Args:
        image: Scene-linear picture, shape (H, W, C).
        st: s and t, shape (H, W, 2); NaN: the result is 0 there.
        filter: Interpolation: ``cubic`` or ``linear``.
        antialias: Whether to average where the map shrinks the picture.
    """
    given = to_numbers(st, "stmap", "st", "shape (H, W, 2)", UsageError)
    values = np.asarray(given, np.float32)

    def make(canvas: Canvas) -> Step:
        if values.shape != (canvas.height, canvas.width, 2):
            raise UsageError(
                f"stmap: wanted shape {(canvas.height, canvas.width, 2)}, got {values.shape}"
            )
        moved = _displacements(values, canvas, Rows(0, canvas.height))
        warp = Warp.of_pixels(moved, canvas.height, 0)
        return WarpStep(canvas, [warp], filter=filter, antialias=antialias)

    return step_on_array("stmap", image, make)
