"""RGB color spaces of pictures: primaries, white and transfer curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import srgb
from .illuminants import D65_STATED, xyz_of_xy

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class ColorSpace:
    """A color space of pictures.

    Attributes:
        name: Name that users type.
        title: Name that viewers show.
        primaries: Chromaticities of red, green and blue, x and y.
        curve: (g, a, b, c, d): linear = (a v + b)^g from d on, c v below.
        cicp: Colour primaries and transfer characteristics by ITU-T H.273.
        interop: Name of the primaries in the Color Interop Forum's names of linear spaces.
    """

    name: str
    title: str
    primaries: tuple[tuple[float, float], ...]
    curve: tuple[float, float, float, float, float]
    cicp: tuple[int, int]
    interop: str


# IEC 61966-2-1; ITU-R BT.2020-2, table 4, inverted: E' = a E^0.45 - (a - 1).
_SRGB = (
    srgb.POWER,
    1 / (1 + srgb.OFFSET),
    srgb.OFFSET / (1 + srgb.OFFSET),
    1 / srgb.SLOPE,
    srgb.ENCODED_KNEE,
)


_A, _B = 1.09929682680944, 0.018053968510807


_BT2020 = (1 / 0.45, 1 / _A, (_A - 1) / _A, 1 / 4.5, 4.5 * _B)


P709 = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))  # ITU-R BT.709-6
#: Luminance of linear Rec.709 to the digits of ITU-R BT.709-6, for mixing with gray. Photometry
#: uses ``spectra.luminance_of_rgb()``, which is consistent with the renderer's spectra.
LUMINANCE_709 = np.array([0.2126, 0.7152, 0.0722])


_P3 = ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060))  # SMPTE EG 432-1, white D65


_P2020 = ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046))  # ITU-R BT.2020-2, table 3


COLOR_SPACES = {
    space.name: space
    for space in (
        ColorSpace("srgb", "sRGB", P709, _SRGB, (1, 13), "rec709"),
        ColorSpace("p3", "Display P3", _P3, _SRGB, (12, 13), "p3d65"),
        ColorSpace("rec2020", "Rec.2020", _P2020, _BT2020, (9, 14), "rec2020"),
    )
}


def xyz_from_rgb(space: ColorSpace) -> FloatArray:
    """Matrix from linear light in the space to XYZ, shape (3, 3); D65 white has luminance 1."""
    columns = np.stack([xyz_of_xy(primary) for primary in space.primaries], axis=1)
    return np.asarray(columns * np.linalg.solve(columns, xyz_of_xy(D65_STATED)))


def decoded(values: NDArray[np.float32], name: str) -> NDArray[np.float32]:
    """Decodes values of a colour space to linear light."""
    g, a, b, c, d = COLOR_SPACES[name].curve
    high = np.maximum(np.float32(a) * values + np.float32(b), 0) ** np.float32(g)
    return np.where(values >= d, high, np.float32(c) * values).astype(np.float32)


def encoded(linear: NDArray[np.float64], name: str) -> NDArray[np.float64]:
    """Encodes linear light in a colour space; the inverse of ``decoded``."""
    g, a, b, c, d = COLOR_SPACES[name].curve
    high = (np.maximum(linear, 0) ** (1 / g) - b) / a
    return np.where(linear >= c * d, high, linear / c)
