"""Checks a sensor's values; errors name each value as in the sensor file."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daguerre.checks import number, short
from daguerre.color import illuminants
from daguerre.errors import InputError

from .curve import FloatArray, rising, table
from .data import SensorData

MOST_SIDE, MOST_BITS = 65536, 16
#: Largest condition number of normalised curves; the cameras of the library have 1.2 to 3.
_MOST_ALIKE = 1e4


def check(sensor: SensorData) -> None:
    """Raises ``InputError`` for the first invalid value."""
    where = f"sensor {sensor.name}"
    _light(sensor, where)
    _within(where, "pixel_pitch", sensor.pixel_pitch, 0.1, 1000)
    for side, count in zip(("columns", "rows"), sensor.resolution, strict=True):
        _whole(where, f"resolution: {side}", count, 1, MOST_SIDE)
    for length in sensor.size:
        _within(where, "size", length, 0.001, 1000)
    _whole(where, "bit_depth", sensor.bit_depth, 1, MOST_BITS)
    _whole(where, "black_level", sensor.black_level, 0, 2**sensor.bit_depth - 2)
    _whole(where, "serial", sensor.serial, 0, 2**63 - 1)
    _within(where, "fill_factor", sensor.fill_factor, 0, 1, above=0)
    _within(where, "full_well", sensor.full_well, 1, 1e8)
    for name, most in (("prnu", 0.5), ("dsnu", 1e6), ("crosstalk", 0.8)):
        _within(where, name, getattr(sensor, name), 0, most)
    _within(where, "low_pass", sensor.low_pass, 0, 4 * sensor.pixel_pitch)
    dark, hot = sensor.dark_current, sensor.hot_pixels
    _within(where, "dark_current: rate", dark.rate, 0, 1e9)
    _within(where, "dark_current: temperature", dark.temperature, -273, 200)
    _within(where, "dark_current: doubling", dark.doubling, 0, 100, above=0)
    _within(where, "hot_pixels: share", hot.share, 0, 1)
    _within(where, "hot_pixels: rate", hot.rate, 0, 1e9)
    _iso(sensor, where)


def _light(sensor: SensorData, where: str) -> None:
    if not sensor.channels or len(set(sensor.channels)) != len(sensor.channels):
        raise InputError(f"{where}: channels: names must differ, got {short(sensor.channels)}")
    nm = rising(f"{where}: wavelengths", sensor.wavelengths)
    rows = list(sensor.quantum_efficiency)
    if len(rows) != len(sensor.channels):
        raise InputError(
            f"{where}: quantum_efficiency: wanted a curve for each of "
            f"{', '.join(sensor.channels)}, got {len(rows)}"
        )
    for name, row in zip(sensor.channels, rows, strict=True):
        curve = table(f"{where}: quantum_efficiency: {name}", nm, row)
        if not ((nm > 380) & (nm < 780) & (curve > 0)).any():
            raise InputError(
                f"{where}: quantum_efficiency: {name}: no value above 0 between 380 and 780 nm"
            )
    object.__setattr__(sensor, "wavelengths", nm)
    all_rows = table(f"{where}: quantum_efficiency", nm, rows)
    object.__setattr__(sensor, "quantum_efficiency", all_rows)
    if not tells_colors(all_rows, nm):
        raise InputError(
            f"{where}: quantum_efficiency: the curves of {', '.join(sensor.channels)} must be "
            f"linearly independent between 380 and 780 nm, but one is nearly a combination of "
            f"the others"
        )
    if sensor.pattern.cells.max() >= len(sensor.channels):
        raise InputError(
            f"{where}: pattern: wanted a pattern of the channels {', '.join(sensor.channels)}, got "
            f"{sensor.pattern.name}"
        )
    for name in ("infrared_cut", "cover_glass"):
        curve = getattr(sensor, name)
        if curve is not None:
            at = rising(f"{where}: {name}: wavelengths", curve.wavelengths)
            table(f"{where}: {name}: transmittance", at, curve.values)


def tells_colors(curves: FloatArray, nm: FloatArray) -> bool:
    """Whether the curves are linearly independent, which the conversion to XYZ needs."""
    fine = np.array([np.interp(illuminants.NM, nm, row, left=0, right=0) for row in curves])
    sizes = np.linalg.norm(fine, axis=1, keepdims=True)
    return bool((sizes > 0).all() and np.linalg.cond(fine / sizes) < _MOST_ALIKE)


def _iso(sensor: SensorData, where: str) -> None:
    low, high = sensor.iso_range
    _within(where, "iso_range: lowest", low, 0.01, 1e7)
    _within(where, "iso_range: highest", high, low, 1e7)
    _within(where, "base_iso", sensor.base_iso, low, high)
    if not sensor.read_noise:
        raise InputError(f"{where}: read_noise: empty, wanted the noise for at least one ISO")
    last = 0.0
    for iso, noise in sensor.read_noise:
        _within(where, "read_noise: iso", iso, last, 1e7, above=last)
        _within(where, f"read_noise: at ISO {iso:g}", noise, 0, 1e6)
        last = iso
    if sensor.dual_gain is not None:
        _within(where, "dual_gain: iso", sensor.dual_gain.iso, low, high)
        _within(where, "dual_gain: full_well", sensor.dual_gain.full_well, 1, 1e8)


def _within(
    where: str, what: str, value: object, low: float, high: float, *, above: float | None = None
) -> None:
    number(value, f"{where}: {what}", low, high, above=above, error=InputError)


def _whole(where: str, what: str, value: Any, low: int, high: int) -> None:
    _within(where, what, value, low, high)
    if not float(value).is_integer() or math.isnan(float(value)):
        raise InputError(f"{where}: {what}: wanted a whole number, got {value}")
