"""Looks: tone curves from light to display, and their saturation.

All curves are y = M x^c / (x^c + k), the sigmoid of a film's characteristic curve (and of many
measured responses, Naka and Rushton 1966): a straight middle of slope c (1 - y / M) over log
light, a toe and a shoulder. M and k are set so that middle grey stays where ISO 12232 puts it, and
a stated light becomes white.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from daguerre._core import curve_breakpoints
from daguerre.color import spaces
from daguerre.errors import UsageError, suggest
from daguerre.sensors.iso_speed import GREY

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Look:
    """A tone curve.

    Attributes:
        contrast: c of the sigmoid; None: light as it is, up to white.
        white: Light that becomes white, where the sensor is not saturated before.
        color: How far colours stand from grey, against the scene's.
        black: Developed value of no light.
    """

    contrast: float | None = None
    white: float = 1.0
    color: float = 1.0
    black: float = 0.0

    def curve(self, light: FloatArray, most: float) -> FloatArray:
        """Returns display light; ``most``: the light at which the sensor saturates."""
        if self.contrast is None:
            return np.minimum(light, 1.0)
        # No such curve exists for a white closer to grey.
        white = max(min(self.white, most), 1.0)
        c, top, grey = self.contrast, white**self.contrast, GREY**self.contrast
        height = GREY * (top - grey) / (GREY * top - grey)
        shape = height * light**c / (light**c + (height - 1) * top)
        return np.asarray(np.minimum(np.hypot(shape, self.black), 1.0))


LOOKS = {
    "neutral": Look(),
    "standard": Look(contrast=1.5, white=4.0),
    "film": Look(contrast=1.6, white=8.0, color=0.9, black=0.0015),
    "filmic": Look(contrast=1.2, white=16.0),
}


def look_of(name: str) -> Look:
    """Returns a look by name.

    Raises:
        UsageError: The name is unknown.
    """
    if name not in LOOKS:
        raise UsageError(
            f"develop: look: wanted one of {', '.join(LOOKS)} or ocio:VIEW, got {name!r}"
            f"{suggest(name, LOOKS)}"
        )
    return LOOKS[name]


def tone_table(look: Look, most: float) -> list[float] | None:
    """Tone curve at the core's breakpoints; None: not needed."""
    if look.contrast is None:
        return None
    values: list[float] = look.curve(_breakpoints(), most).tolist()
    return values


@cache
def encode_table(space: str) -> list[float] | None:
    """Transfer curve of a colour space at the core's breakpoints; None: it is linear."""
    if spaces.COLOR_SPACES[space].is_linear:
        return None
    values: list[float] = np.minimum(spaces.encoded(_breakpoints(), space), 1.0).tolist()
    return values


@cache
def _breakpoints() -> FloatArray:
    return np.array(curve_breakpoints(), np.float64)


def saturation(amount: float, luminance: FloatArray) -> FloatArray:
    """Matrix that scales the distance of colours from the grey of their luminance, (3, 3)."""
    return np.asarray(amount * np.eye(3) + (1 - amount) * np.outer(np.ones(3), luminance))
