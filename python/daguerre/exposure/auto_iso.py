"""Automatic ISO: its limits, and the rounded ISO of an exposure."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from daguerre.sensors.sensor import Sensor

#: Limits of an automatic ISO; a sensor may have fewer.
ISOS = (100.0, 6400.0)
#: ISOs above this are whole numbers.
_WHOLE = 50.0


def iso_limits(sensor: Sensor | None) -> tuple[float, float]:
    """Lowest and highest automatic ISO of a sensor; None: a perfect sensor."""
    low, high = ISOS
    if sensor is not None:
        low, high = max(low, sensor.iso_range[0]), min(high, sensor.iso_range[1])
        if low > high:  # none in common: the sensor's end that is nearer
            low = high = min(sensor.iso_range, key=lambda iso: abs(math.log(iso / ISOS[0])))
    return low, high


def automatic_iso(wanted: float, limits: tuple[float, float]) -> float:
    """ISO nearest to a wanted one within its limits, rounded as messages show it."""
    low, high = limits
    iso = float(round(min(max(wanted, low), high), 0 if wanted > _WHOLE else 2))
    return min(max(iso, low), high)
