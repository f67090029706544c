"""Colour of a black body, with the bits of UsdLux."""

from __future__ import annotations

import numpy as np

Color = tuple[float, float, float]
_FIRST, _RANGE = np.float32(1000), np.float32(9000)  # K
#: Linear Rec.709 from 1000 to 10000 K, every 500 K. Source: OpenUSD, usdLux/blackbody.cpp, which
#: has them from John Walker, "Colour Rendering of Spectra", fourmilab.ch.
_COLORS = np.array([
    (1, 0.02749, 0), (1, 0.149664, 0), (1, 0.256644, 0.008095), (1, 0.372033, 0.06745),
    (1, 0.476725, 0.153601), (1, 0.570376, 0.259196), (1, 0.65348, 0.377155),
    (1, 0.726878, 0.501606), (1, 0.791543, 0.62805), (1, 0.848462, 0.753228),
    (1, 0.898581, 0.874905), (1, 0.942771, 0.991642), (0.906947, 0.890456, 1),
    (0.828247, 0.841838, 1), (0.765791, 0.801896, 1), (0.715255, 0.768579, 1),
    (0.673683, 0.740423, 1), (0.638992, 0.716359, 1), (0.609681, 0.695588, 1),
], np.float32)  # fmt: skip
#: The same, with the ends repeated for splines that run through all of them.
_KNOTS = np.concatenate([_COLORS[:1], _COLORS, _COLORS[-1:], _COLORS[-1:]])
#: Cubic coefficients from four knots. Source: Catmull and Rom, "A class of local interpolating
#: splines", 1974.
_BASIS = 0.5 * np.array([(-1, 3, -3, 1), (2, -5, 4, -1), (-1, 0, 1, 0), (0, 2, 0, 0)], np.float32)
_LUMA = np.array([0.2126, 0.7152, 0.0722], np.float32)


def blackbody(kelvin: float) -> Color:
    """Linear Rec.709 of a black body, luminance 1; constant beyond 1000 and 10000 K.

    Sums run in the order and the precision of UsdLuxBlackbodyTemperatureAsRgb.
    """
    with np.errstate(over="ignore"):
        place = np.clip((np.float32(kelvin) - _FIRST) / _RANGE, 0, 1) * np.float32(len(_KNOTS) - 4)
    first = int(place)
    share = place - np.float32(first)
    k = _KNOTS[first : first + 4]
    a, b, c, d = (((w * k[0] + x * k[1]) + y * k[2]) + z * k[3] for w, x, y, z in _BASIS)
    rgb = ((a * share + b) * share + c) * share + d
    red, green, blue = rgb * _LUMA
    scaled = (rgb.astype(np.float64) * (1.0 / float(red + green + blue))).astype(np.float32)
    made = np.maximum(scaled, 0)
    return float(made[0]), float(made[1]), float(made[2])
