"""Image sensors: the library, files of the schema ``daguerre-sensor/0.1``, and ``Sensor``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.lazy_imports import lazy_attributes

if TYPE_CHECKING:
    from .curve import Curve
    from .data import DarkCurrent, DualGain, HotPixels
    from .ideal_sensor import ideal
    from .library import load, names
    from .mosaic import PATTERNS, Mosaic
    from .reader import read
    from .sensor import Sensor

__all__ = [
    "PATTERNS",
    "Curve",
    "DarkCurrent",
    "DualGain",
    "HotPixels",
    "Mosaic",
    "Sensor",
    "ideal",
    "load",
    "names",
    "read",
]

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = lazy_attributes(
        __name__,
        {
            "Curve": "curve",
            "DarkCurrent": "data",
            "DualGain": "data",
            "HotPixels": "data",
            "Mosaic": "mosaic",
            "PATTERNS": "mosaic",
            "Sensor": "sensor",
            "ideal": "ideal_sensor",
            "load": "library",
            "names": "library",
            "read": "reader",
        },
    )
