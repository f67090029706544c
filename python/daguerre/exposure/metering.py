"""Metering: the luminance that a camera measures, and the ISO that its time and stop need.

A meter takes the mean of some part of the picture for middle grey. Its luminance L, cd/m2, gives
EV100 = log2(100 L / K), with K = 12.5 cd s/m2, the calibration of most cameras (ISO 2720). The ISO
follows from the exposure on the film itself, through lens and filters as in a camera: 10 / ISO lux
s become middle grey (ISO 12232), so the metered part develops to 0.18. For an ideal lens both agree
within 2 %: (pi / 4) K = 9.8.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.camera.exposure_mode import METERS
from daguerre.checks import numbers, short
from daguerre.color.spectra import luminance_of_rgb
from daguerre.errors import InputError, UsageError, suggest
from daguerre.frame.frame import Frame
from daguerre.sensors.iso_speed import GREY, GREY_LX_S

from .lux_seconds import display_gain, luminance_exposure

FloatArray = NDArray[np.float64]
#: cd s/m2: ISO 2720 allows 10.6 to 13.4; Canon, Nikon and Sekonic have 12.5.
K = 12.5
#: Centre: a circle of half the frame's height (12 mm of 36 x 24) has this share of the weight.
CENTER_SHARE, CENTER_DIAMETER = 0.75, 0.5
#: Spot: a circle of this share of the frame's area.
SPOT_AREA = 0.025
#: Matrix: zones across and down; weight of zones at the point in focus.
ZONES, FOCUS_WEIGHT = (9, 7), 3.0
#: A zone this many times as bright as middle grey is white; it may cost the rest one stop at most.
WHITE_OVER_GREY, MOST_PROTECTION = 1 / GREY, 2.0
#: Zones count at least as this share of the brightest, so that a night sky does not weigh in.
DARKEST_ZONE = 2.0**-10
#: Highlight: this share of the picture may be brighter than white.
WHITE_SHARE = 0.01
_STRIPE = 256  # rows


@guarded
@dataclass(frozen=True)
class Metered:
    """Reading of a light meter.

    Attributes:
        mode: Metering pattern: centre, spot, matrix or highlight.
        luminance: Luminance taken for middle grey, cd/m2.
        iso: ISO that makes that luminance middle grey with the frame's time and stop.
    """

    mode: str
    luminance: float
    iso: float

    @property
    def ev100(self) -> float:
        """Exposure value at ISO 100."""
        return ev100_of(self.luminance)

    def __str__(self) -> str:
        return (
            f"{self.mode}: {self.luminance:.3g} cd/m2, EV100 {self.ev100:.1f}, ISO {self.iso:.3g}"
        )


def ev100_of(luminance: float) -> float:
    """Exposure value at ISO 100 that makes a luminance, cd/m2, middle grey."""
    return math.log2(100 * luminance / K)


def wanted_lux_s(luminance: float, ev: float = 0.0) -> float:
    """Exposure of a value of 1 at ISO 1 that makes a luminance, cd/m2, middle grey, lux s.

    Args:
        luminance: The luminance.
        ev: Exposure compensation, EV.
    """
    return float(2.0**ev * GREY_LX_S / luminance)


@guarded
def check_mode(mode: str, where: str = "meter") -> str:
    """Checks the name of a metering pattern; ``center`` is valid, too.

    Raises:
        UsageError: No such pattern.
    """
    known = "centre" if mode == "center" else mode
    if known not in METERS:
        raise UsageError(
            f"{where}: wanted {', '.join(METERS)}, got {short(mode)}{suggest(short(mode), METERS)}"
        )
    return known


@guarded
def meter(frame: Frame, mode: str = "centre", *, at: tuple[float, float] | None = None) -> Metered:
    """Meters a frame as a camera does.

    Args:
        frame: With exposure metadata.
        mode: ``centre``: mean luminance, three quarters of it from the middle; ``spot``: mean of a
            fortieth of the area, about the point in focus; ``matrix``: zones, with most weight on
            the point in focus and on highlights; ``highlight``: all but a hundredth of the picture
            stays below white.
        at: Point in focus, px of the whole frame; None: its middle.

    Raises:
        UsageError: No such pattern, or the point is outside of the picture.
        InputError: The metered part is black, or the frame lacks metadata of its exposure.
    """
    mode = check_mode(mode)
    luminance = luminance_of(frame, mode, at)
    if not luminance > 0:
        raise InputError(f"meter: {mode}: the metered area is black: there is no light to meter")
    unit = luminance_exposure(frame.metadata)
    return Metered(mode, luminance, GREY_LX_S / (luminance * unit))


def stops_over(frame: Frame, mode: str, at: tuple[float, float] | None = None) -> float | None:
    """Distance of a picture from the meter, EV: above 0, it shows the metered part too bright.

    Args:
        frame: Frame with exposure metadata.
        mode: Metering pattern.
        at: Point in focus, px of the whole frame; None: its middle.

    Returns:
        None: The metered part is black or outside of the frame.

    Raises:
        InputError: The frame lacks metadata of its exposure.
    """
    try:
        luminance = luminance_of(frame, mode, at)
    except UsageError:  # a crop without the spot
        return None
    return stops_over_grey(frame, luminance)


def stops_over_grey(frame: Frame, luminance: float) -> float | None:
    """How much brighter than middle grey a frame's picture shows a luminance, EV; see above."""
    shown = display_gain(frame.metadata) * luminance
    return math.log2(shown / GREY) if 0 < shown < math.inf else None


def luminance_of(frame: Frame, mode: str, at: tuple[float, float] | None = None) -> float:
    """Luminance that a pattern takes for middle grey, cd/m2; see :func:`meter`."""
    frame = frame.without_overscan()
    place = _Place.of(frame, at)
    if mode == "matrix":
        return _matrix(frame, place)
    if mode == "highlight":
        return _highlight(frame)
    weight = _center_weight if mode == "centre" else _spot_weight
    total, light = 0.0, 0.0
    for rows, y in _luminances(frame):
        weights = weight(place, rows)
        total += float(weights.sum())
        light += float((weights * y).sum())
    if not total > 0:
        raise UsageError(f"meter: spot at {place.focus}: wanted a point inside the picture")
    return light / total


@dataclass(frozen=True)
class _Place:
    """Position of the frame's pixels in the whole picture, px.

    Attributes:
        width, height: Size of the whole picture.
        left, top: Place of the frame within it.
        columns: Width of the frame.
        focus: Point in focus.
    """

    width: int
    height: int
    left: int
    top: int
    columns: int
    focus: tuple[float, float]

    @classmethod
    def of(cls, frame: Frame, at: tuple[float, float] | None) -> _Place:
        width, height = frame.metadata.get("resolution") or (frame.width, frame.height)
        left, top = (frame.metadata.get("crop") or (0, 0))[:2]
        focus = (width / 2, height / 2)
        if at is not None:
            x, y = numbers(at, "meter: at", 2, "a pixel (x, y)")
            focus = (x, y)
        return cls(width, height, left, top, frame.width, focus)

    def squared_distance(self, rows: slice, point: tuple[float, float]) -> FloatArray:
        """Squared distance of pixel centres from a point, px^2, shape (rows, columns)."""
        x = self.left + np.arange(self.columns) + 0.5 - point[0]
        y = self.top + np.arange(rows.start, rows.stop) + 0.5 - point[1]
        return np.asarray(x[None, :] ** 2 + y[:, None] ** 2)


def _center_weight(place: _Place, rows: slice) -> FloatArray:
    radius2 = (CENTER_DIAMETER * place.height / 2) ** 2
    inside = place.squared_distance(rows, (place.width / 2, place.height / 2)) < radius2
    area = math.pi * radius2
    outer = max(place.width * place.height - area, 1.0)
    return np.where(inside, CENTER_SHARE / area, (1 - CENTER_SHARE) / outer)


def _spot_weight(place: _Place, rows: slice) -> FloatArray:
    # At least one pixel, even in a tiny picture.
    radius2 = max(SPOT_AREA * place.width * place.height / math.pi, 0.51)
    return np.asarray(place.squared_distance(rows, place.focus) < radius2, np.float64)


def _luminances(frame: Frame) -> Iterator[tuple[slice, FloatArray]]:
    """Strips of rows and their luminance, cd/m2; NaN and negative values count as black."""
    luma = luminance_of_rgb()
    for begin in range(0, frame.height, _STRIPE):
        rows = slice(begin, min(begin + _STRIPE, frame.height))
        y = frame.xyz[rows, :, 1] if frame.xyz is not None else frame.rgb[rows] @ luma
        y = np.asarray(y, np.float64)
        yield rows, np.where(np.isfinite(y) & (y > 0), y, 0.0)


def _highlight(frame: Frame) -> float:
    """Luminance of middle grey where all but the brightest pixels are below white."""
    every = np.concatenate([y.ravel() for _, y in _luminances(frame)])
    return float(GREY * np.quantile(every, 1 - WHITE_SHARE))


def _matrix(frame: Frame, place: _Place) -> float:
    """Mean of the zones in stops; white zones raise it, by one stop at most."""
    across, down = ZONES
    sums, counts = np.zeros(across * down), np.zeros(across * down)
    columns = ((place.left + np.arange(place.columns)) * across) // place.width
    for rows, y in _luminances(frame):
        lines = ((place.top + np.arange(rows.start, rows.stop)) * down) // place.height
        zone = (lines[:, None] * across + columns[None, :]).ravel()
        sums += np.bincount(zone, y.ravel(), across * down)
        counts += np.bincount(zone, minlength=across * down)
    there = counts > 0
    zones = sums[there] / counts[there]
    brightest = zones.max()
    if not brightest > 0:
        return 0.0
    stops = np.log2(np.maximum(zones, DARKEST_ZONE * brightest))
    weights = _zone_weights(place)[there]
    mean = 2.0 ** float((weights * stops).sum() / weights.sum())
    return float(np.clip(brightest / WHITE_OVER_GREY, mean, MOST_PROTECTION * mean))


def _zone_weights(place: _Place) -> FloatArray:
    """Weights of zones: highest at the point in focus, falling with distance to 1."""
    across, down = ZONES
    x = (np.arange(across) + 0.5) / across * place.width - place.focus[0]
    y = (np.arange(down) + 0.5) / down * place.height - place.focus[1]
    away2 = (x[None, :] ** 2 + y[:, None] ** 2) / (place.height / 3) ** 2
    return np.asarray(1 + (FOCUS_WEIGHT - 1) * np.exp(-away2)).ravel()
