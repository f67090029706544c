"""Rays of a lens at one focal length, and the models fitted to them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from daguerre.analysis.bench import Bench, set_up
from daguerre.analysis.field import distortion, lateral_colour
from daguerre.analysis.illumination import relative_illumination
from daguerre.errors import InputError
from daguerre.lenses.focus import closest_focus_m
from daguerre.lenses.lens import Lens
from daguerre.sensors import load as load_sensor

from .frame import FloatArray, Frame
from .models import POWERS, Fit, fit_colour, fit_distortion, fit_vignetting

HEIGHTS = 24  # from axis to corner
LEAST = 8  # heights with chief rays that a fit needs
LIGHTS = 12  # heights of light
GRID = 64  # rays across the pupil
#: Response of a common camera: its red, green and blue weight the wavelengths.
SENSOR = "sony-a7r-ii"
BANDS_NM = np.arange(410.0, 691.0, 20.0)
STOP = 8.0  # for distortion and colour; wide open if the lens is slower
NARROWER = (0, 1, 2, 3, 5)  # stops below wide open, for vignetting
FAR_M = 1000.0  # infinity in lensfun's files
CLOSE = 1.001  # closest focus, and a little for rounding
NEAR = 12  # focal lengths from the lens to a near object: a tenth of its size


@dataclass(frozen=True)
class Geometry:
    """Distortion by each model, and lateral colour, at one focal length; residuals in px."""

    focal_mm: float
    distortion: dict[str, Fit]
    red: Fit
    blue: Fit


@dataclass(frozen=True)
class Vignetting:
    """Vignetting at one focal length, f-stop and distance; residual in EV."""

    focal_mm: float
    f_stop: float
    distance_m: float
    fit: Fit


def geometry(lens: Lens, frame: Frame) -> Geometry:
    """Fits distortion and lateral colour of a lens at its focal length, at infinity."""
    bench = set_up(lens, f_stop=max(STOP, lens.first_order().f_number))
    heights, area = (values[1:] for values in frame.rings(HEIGHTS))
    ideal = distortion(bench, heights).ideal_mm
    red, green, blue = heights + channels() @ lateral_colour(bench, heights, [*BANDS_NM]).T
    known = np.isfinite([ideal, red, green, blue]).all(axis=0)
    if known.sum() < LEAST or heights[known].max() < frame.unit_mm:
        raise InputError(
            f"{lens.name}: lensfun: wanted chief rays out to {frame.unit_mm:.3g} mm (the edge of "
            f"the picture), got {heights[known].max(initial=0):.3g} mm"
        )
    radii = [values[known] / frame.unit_mm for values in (ideal, red, green, blue)]
    ideal, red, green, blue = radii
    pixels = frame.unit_mm / frame.pixel_mm

    def in_pixels(fit: Fit) -> Fit:
        return replace(fit, rms=fit.rms * pixels, largest=fit.largest * pixels)

    return Geometry(
        focal_length(bench),
        {name: in_pixels(fit_distortion(name, ideal, green, area[known])) for name in POWERS},
        in_pixels(fit_colour("r", green, red, area[known])),
        in_pixels(fit_colour("b", green, blue, area[known])),
    )


def vignetting(lens: Lens, frame: Frame) -> list[Vignetting]:
    """Fits vignetting of a lens at its focal length, by f-stop, at infinity and near."""
    order = lens.first_order()
    focal = abs(order.efl)
    near_m = max(CLOSE * closest_focus_m(lens), 1e-3 * NEAR * focal)
    made = []
    for stops in NARROWER:
        f_stop = order.f_number * 2 ** (stops / 2)
        for distance_m in (math.inf, near_m):
            bench = set_up(lens, f_stop=f_stop, focus_m=distance_m, by="paraxial")
            fit = _light(bench, frame)
            made.append(Vignetting(focal, f_stop, min(distance_m, FAR_M), fit))
    return made


def focal_length(bench: Bench) -> float:
    """Focal length by which a profile names a setting, mm."""
    return abs(bench.order.efl)


@cache
def channels() -> FloatArray:
    """Weights of BANDS_NM in red, green and blue, shape (3, L), each with the sum 1."""
    sensor = load_sensor(SENSOR)
    rows = sensor.sensitivity(BANDS_NM)[[sensor.channels.index(name) for name in "RGB"]]
    return np.asarray(rows / rows.sum(axis=1, keepdims=True))


def _light(bench: Bench, frame: Frame) -> Fit:
    heights, area = frame.rings(LIGHTS)
    light = relative_illumination(bench, heights, grid=GRID).relative
    if not np.isfinite(light).all():
        raise InputError(f"{bench.lens.name}: lensfun: wanted light on the axis, got none")
    return fit_vignetting(light, heights / frame.corner_mm, area)
