"""Image sensors: the library, files of the schema ``daguerre-sensor/0.1``, and ``Sensor``."""

from .curve import Curve
from .data import DarkCurrent, DualGain, HotPixels
from .ideal import ideal
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
