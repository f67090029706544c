"""Camera geometry for lens effects: conversion between millimetres and pixels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeGuard

import numpy as np
from numpy.typing import NDArray

from daguerre import units
from daguerre.convolution.rows import Rows
from daguerre.errors import UsageError

from .effect import Values
from .parameter import Parameter
from .picture import Canvas

if TYPE_CHECKING:
    from daguerre.analysis.bench import Bench

FOCAL_LENGTH = Parameter("focal_length", "focal length; default: from the file", "mm", low=1e-3)
SENSOR = Parameter("sensor", "sensor width x height; default: from the file", "mm", kind="size")
LENS = (
    Parameter("lens", "a name from `daguerre lenses`, or a lens file", kind="library"),
    Parameter("focus", "focus distance from the entrance pupil", "m", math.inf, low=1e-3),
    Parameter("zoom", "focal length of a zoom", "mm", low=1e-3),
    Parameter(
        "focus_by", "focus by the paraxial image, or by the smallest spot", kind="choice",
        default="paraxial", choices=("paraxial", "best"),
    ),
    Parameter(
        "f_stop", "f-stop of the lens; default: wide open", low=1e-2, parse=units.f_number,
        wants=units.F_NUMBER,
    ),
)  # fmt: skip


@dataclass(frozen=True)
class Plane:
    """Film plane of a picture.

    Attributes:
        center: Point at which the axis meets it, px.
        pitch_mm: Pixel pitch, mm.
    """

    center: tuple[float, float]
    pitch_mm: float

    def radii(self, canvas: Canvas, rows: Rows) -> NDArray[np.float32]:
        """Distance of pixels from the axis, mm, shape (rows, W)."""
        x, y = offsets(canvas, rows, self.center)
        return np.hypot(x, y) * np.float32(self.pitch_mm)


def offsets(
    canvas: Canvas, rows: Rows, center: tuple[float, float]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Offsets of pixel columns (1, W) and rows (rows, 1) from a point of the display window, px."""
    x = np.arange(canvas.width) + (canvas.corner[0] + 0.5 - center[0])
    y = np.arange(rows.begin, rows.end) + (canvas.corner[1] + 0.5 - center[1])
    return x[None, :].astype(np.float32), y[:, None].astype(np.float32)


def film_plane(canvas: Canvas, values: Values) -> Plane:
    """Returns the film plane from ``sensor``, else from the file; the picture spans its width.

    Raises:
        UsageError: Neither gives its size.
    """
    pitch_mm = _pitch_mm(canvas, values)
    if pitch_mm is None:
        raise UsageError(
            f"{canvas.where}: sensor: the file has none; give its size in mm, such as sensor=36x24"
        )
    return Plane(axis(canvas, values), pitch_mm)


def axis(canvas: Canvas, values: Values) -> tuple[float, float]:
    """Point at which the lens's axis meets the picture, px: its middle, less the file's offset.

    ``sensorCenterOffset`` is the offset of the sensor's middle to the right and up, um, as the
    picture is seen; converting it needs the pixel pitch.
    """
    offset, pitch_mm = canvas.facts.get("sensorCenterOffset"), _pitch_mm(canvas, values)
    x, y = canvas.center
    if pitch_mm is None or not _finite(offset):
        return x, y
    return x - 1e-3 * offset[0] / pitch_mm, y + 1e-3 * offset[1] / pitch_mm


def _pitch_mm(canvas: Canvas, values: Values) -> float | None:
    """Pixel pitch, mm; None: unknown."""
    size, pitch = values.get("sensor"), canvas.facts.get("sensorPhotositePitch")
    if size is None and _positive(pitch):
        return pitch[0] * 1e-3
    size = size or canvas.facts.get("sensorOverallDimensions")
    return size[0] / canvas.full_size[0] if _positive(size) else None


def focal_length_mm(canvas: Canvas, values: Values) -> float:
    """Returns the focal length from ``focal_length``, else from the file.

    Raises:
        UsageError: Neither gives it.
    """
    if values.get("focal_length"):
        return float(values["focal_length"])
    for name in ("pinholeFocalLength", "effectiveFocalLength", "nominalFocalLength"):
        found = canvas.facts.get(name)
        if isinstance(found, float) and 0 < found < math.inf:
            return found
    raise UsageError(
        f"{canvas.where}: focal_length: the file has none; give it in mm, such as focal_length=50"
    )


def bench(values: Values) -> Bench:
    """Returns the lens at its focus, zoom and f-stop.

    Raises:
        InputError: The lens is unknown, or the setting is out of its range.
    """
    from daguerre import lenses
    from daguerre.analysis.bench import on_bench
    from daguerre.lenses.setting import LensSetting

    setting = LensSetting(
        values.get("f_stop"), values["focus"], values.get("zoom"), values["focus_by"]
    )
    return on_bench(lenses.load(values["lens"]), setting)


def stop_remark_of(values: Values) -> str | None:
    """Note that a lens is wide open, as the given f-stop is a little wider than it opens."""
    if values.get("lens") is None or values.get("f_stop") is None:
        return None
    from daguerre import lenses
    from daguerre.lenses.engraved import stop_remark

    return stop_remark(lenses.load(values["lens"]), values["f_stop"], values.get("zoom"))


def _finite(pair: object) -> TypeGuard[tuple[float, float]]:
    return isinstance(pair, tuple) and len(pair) == 2 and all(math.isfinite(v) for v in pair)


def _positive(pair: object) -> TypeGuard[tuple[float, float]]:
    return isinstance(pair, tuple) and len(pair) == 2 and all(0 < v < math.inf for v in pair)
