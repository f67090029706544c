"""Lamps over time: their colour times a factor, and their place without scale."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.files.value import Value
from daguerre.motion.values import Dynamic
from daguerre.scene.transforms import without_scale

Color = tuple[float, float, float]
#: Largest part of a colour; its product with an area still fits into single precision.
MOST = 1e30


def times(color: Color, factor: float) -> Color:
    """A colour times a factor, each part from 0 to ``MOST``."""
    red, green, blue = (min(max(0.0, factor * part), MOST) for part in color)
    return red, green, blue


@dataclass(frozen=True, eq=False)
class Times(Value):
    """A colour over time, times a factor."""

    color: Dynamic
    factor: float

    def at(self, time_s: float) -> Color:
        """The colour at a time, s."""
        return times(self.color.at(time_s), self.factor)

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of the keys, s."""
        return list(self.color.breaks(begin, end))


@dataclass(frozen=True, eq=False)
class Rigid(Value):
    """A transform over time without its scale."""

    world: Dynamic

    def at(self, time_s: float) -> NDArray[np.float64]:
        """The transform at a time, s, shape (4, 4)."""
        made = without_scale(np.asarray(self.world.at(time_s), np.float64))
        if made is None:
            raise InputError(f"lamp: wanted a size above 0, got 0 at {time_s} s")
        return made

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of the keys, s."""
        return list(self.world.breaks(begin, end))
