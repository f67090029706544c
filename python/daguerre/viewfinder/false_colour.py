"""False colour: how many stops each pixel of the picture is from middle grey.

Zones are whole stops about 18 % grey, as in Ed Lachman's EL Zone. The colours are ours: lightness
rises by equal steps from zone to zone, shadows are blue, highlights yellow, and middle grey keeps
its own grey. So the order is plain without hue, and the hues differ for all kinds of colour
blindness (``tests/viewfinder/test_aids.py``). Oklab: B. Ottosson, 2020.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.color.spectra import luminance_of_rgb
from daguerre.color.srgb import from_linear
from daguerre.exposure.lux_seconds import display_gain
from daguerre.frame.frame import Frame
from daguerre.sensors.iso_speed import GREY

#: Stops below and above middle grey that have zones; the end zones have everything beyond, too.
REACH = 6
_DARKEST, _LIGHTEST = 0.17, 0.97
#: Chroma toward blue and yellow just beside grey and at the ends, as far as sRGB reaches.
_BLUE, _YELLOW = (0.06, 0.07), (0.06, 0.11)


def stops_from_grey(frame: Frame) -> NDArray[np.float64]:
    """Stops from middle grey in the picture of a frame, (H, W); black is minus infinity.

    Raises:
        InputError: The frame lacks metadata of its exposure.
    """
    light = frame.xyz[..., 1] if frame.xyz is not None else frame.rgb @ luminance_of_rgb()
    shown = np.asarray(light, np.float64) * (display_gain(frame.metadata) / GREY)
    with np.errstate(divide="ignore"):
        return np.asarray(np.log2(np.where(shown > 0, shown, 0.0)))  # NaN is black, too


def false_colour(frame: Frame) -> NDArray[np.uint8]:
    """Colours of the zones of a frame, (H, W, 3)."""
    stops = np.clip(stops_from_grey(frame), -REACH, REACH)
    return np.asarray(zone_colours()[np.rint(stops).astype(int) + REACH])


def zone_colours() -> NDArray[np.uint8]:
    """Colours of the zones, the darkest first, (2 REACH + 1, 3), sRGB."""
    grey = np.cbrt(GREY)
    stops = np.arange(-REACH, REACH + 1)
    share = np.abs(stops) / REACH
    end = np.where(stops < 0, _DARKEST, _LIGHTEST)
    blue, yellow = (low + (high - low) * share for low, high in (_BLUE, _YELLOW))
    b = np.where(stops < 0, -blue, yellow) * (stops != 0)
    linear = _linear(grey + (end - grey) * share, b)
    return np.asarray(np.rint(255 * from_linear(np.clip(linear, 0, 1))), np.uint8)


def _linear(lightness: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Linear sRGB of Oklab colours without red and green (a = 0)."""
    cones = np.stack([lightness + m * b for m in (0.2158037573, -0.0638541728, -1.2914855480)])
    matrix = np.array(
        [
            [4.0767416621, -3.3077115913, 0.2309699292],
            [-1.2684380046, 2.6097574011, -0.3413193965],
            [-0.0041960863, -0.7034186147, 1.7076147010],
        ]
    )
    return np.asarray((matrix @ cones**3).T)
