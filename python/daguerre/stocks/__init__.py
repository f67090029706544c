"""Film stocks: exposure, development, printing and scanning; see ``docs/film-stocks.md``."""

from .curve import CharacteristicCurve
from .library import load, names
from .negative import Negative
from .reader import read
from .stock import Halation, Layer, Stock

__all__ = [
    "CharacteristicCurve",
    "Halation",
    "Layer",
    "Negative",
    "Stock",
    "load",
    "names",
    "read",
]
