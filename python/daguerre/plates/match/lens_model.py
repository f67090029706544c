"""Response and falloff of a library lens as rendered."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.analysis.bench import Bench, set_up
from daguerre.analysis.illumination import relative_illumination
from daguerre.analysis.mtf import geometric_mtf
from daguerre.analysis.pencils import pencil
from daguerre.analysis.spots import spot
from daguerre.camera.camera import Camera
from daguerre.camera.ideal import IDEAL
from daguerre.setup.checks import prescription_of

from .falloff import Terms, fitted

FloatArray = NDArray[np.float64]
_HEIGHTS, _GRID = 9, 48


def bench_of(camera: Camera) -> Bench | None:
    """Returns the camera's lens on the bench; None: the lens is ideal.

    Raises:
        InputError: The lens does not have this f-stop, zoom or focus.
    """
    if camera.lens is None or camera.lens in IDEAL:
        return None
    focus = camera.focus_distance or math.inf
    return set_up(prescription_of(camera), f_stop=camera.f_stop, focus_m=focus, zoom_mm=camera.zoom)


def lens_response(bench: Bench, pitch_mm: float, frequency: FloatArray) -> FloatArray:
    """Modulation of the lens alone on its axis, by rays as it is rendered, shape (F,).

    Args:
        bench: The lens.
        pitch_mm: Side of a pixel, mm.
        frequency: Cycles per pixel, shape (F,).
    """
    light = pencil(bench)
    if light is None:
        return np.ones_like(frequency)
    return np.asarray(geometric_mtf(spot(light), frequency / pitch_mm).mean(axis=1))


def lens_falloff(bench: Bench, sensor_size: tuple[float, float]) -> Terms:
    """The lens's falloff over a sensor (mm), as the polynomial of ``Falloff``."""
    corner = 0.5 * math.hypot(*sensor_size)
    heights = np.linspace(0, min(corner, 1.05 * bench.field_mm), _HEIGHTS)
    light = relative_illumination(bench, heights, grid=_GRID).relative
    return fitted(np.asarray(light), (heights / corner) ** 2).terms
