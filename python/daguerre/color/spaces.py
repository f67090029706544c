"""Color spaces by the names that users type: the one table behind flags, files and docs.

Chromaticities: ITU-R BT.709-6 and BT.2020-2 (table 3); SMPTE EG 432-1 (P3); SMPTE ST 2065-1 (AP0);
Academy S-2014-004 (AP1); CIE 015:2018 (XYZ).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import short
from daguerre.errors import UsageError, suggest

from . import srgb
from .illuminants import D65_STATED, xyz_of_xy

FloatArray = NDArray[np.float64]
XY = tuple[float, float]
Curve = tuple[float, float, float, float, float]

P709: tuple[XY, ...] = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))
P3: tuple[XY, ...] = ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060))
P2020: tuple[XY, ...] = ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046))
AP0: tuple[XY, ...] = ((0.7347, 0.2653), (0.0, 1.0), (0.0001, -0.0770))
AP1: tuple[XY, ...] = ((0.713, 0.293), (0.165, 0.830), (0.128, 0.044))
#: XYZ itself: with white E, which is (1, 1, 1), the numbers are tristimulus values.
XYZ: tuple[XY, ...] = ((1.0, 0.0), (0.0, 1.0), (0.0, 0.0))
ACES_WHITE: XY = (0.32168, 0.33767)
E_WHITE: XY = (1 / 3, 1 / 3)
#: Luminance of linear Rec.709 to the digits of ITU-R BT.709-6, for mixing with gray. Photometry
#: uses ``spectra.luminance_of_rgb()``, which is consistent with the renderer's spectra.
LUMINANCE_709 = np.array([0.2126, 0.7152, 0.0722])


@dataclass(frozen=True)
class ColorSpace:
    """A color space of pictures.

    Attributes:
        name: Name that users type.
        title: Name that viewers show.
        primaries: Chromaticities of red, green and blue, x and y; empty: a camera's.
        interop: Name of the linear space in the Color Interop Forum's list; empty: none.
        curve: (g, a, b, c, d): linear = (a v + b)^g from d on, c v below; None: linear.
        cicp: Colour primaries and transfer characteristics by ITU-T H.273; None: it has no curve.
        white: Chromaticity of (1, 1, 1).
        neutral: Chromaticity that is white in a scene; None: ``white``.
    """

    name: str
    title: str
    primaries: tuple[XY, ...]
    interop: str
    curve: Curve | None = None
    cicp: tuple[int, int] | None = None
    white: XY = D65_STATED
    neutral: XY | None = None

    @property
    def is_linear(self) -> bool:
        """Whether numbers are proportional to light."""
        return self.curve is None


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
CAMERA = "camera"
COLOR_SPACES = {
    space.name: space
    for space in (
        ColorSpace("srgb", "sRGB", P709, "lin_rec709_scene", _SRGB, (1, 13)),
        ColorSpace("p3", "Display P3", P3, "lin_p3d65_scene", _SRGB, (12, 13)),
        ColorSpace("rec2020", "Rec.2020", P2020, "lin_rec2020_scene", _BT2020, (9, 14)),
        ColorSpace("lin_rec709", "linear Rec.709", P709, "lin_rec709_scene"),
        ColorSpace("acescg", "ACEScg", AP1, "lin_ap1_scene", white=ACES_WHITE),
        ColorSpace("aces", "ACES2065-1", AP0, "lin_ap0_scene", white=ACES_WHITE),
        ColorSpace(
            "xyz", "CIE XYZ, D65", XYZ, "lin_ciexyzd65_scene", white=E_WHITE, neutral=D65_STATED
        ),
        ColorSpace(CAMERA, "the camera's own colors", (), ""),
    )
}
#: Spaces of pictures that are encoded for a display, and spaces of scene-linear OpenEXR.
ENCODED = tuple(name for name, space in COLOR_SPACES.items() if space.curve is not None)
LINEAR = tuple(name for name, space in COLOR_SPACES.items() if space.is_linear and space.primaries)
#: Working space: of ``Frame.rgb``, and of files without another space.
WORKING = "lin_rec709"


def check_linear(name: str, where: str) -> str:
    """Checks the name of a space of scene-linear files, and returns it.

    Raises:
        UsageError: It is unknown, encoded for a display, or the camera's own.
    """
    if name in LINEAR:
        return name
    wanted = f"{', '.join(LINEAR[:-1])} or {LINEAR[-1]}"
    why = suggest(name, LINEAR)
    if name in ENCODED:
        why = (
            f", whose numbers are encoded for a display; a frame is linear (`develop` takes {name})"
        )
    elif name == CAMERA:
        why = (
            ", which a frame does not have; --sensor adds the sensor's channels, and `develop` "
            "takes camera for raw files"
        )
    raise UsageError(f"{where}: wanted {wanted}, got {short(name)}{why}")


def xyz_of_primaries(primaries: tuple[XY, ...], white: XY) -> FloatArray:
    """Matrix from linear light to XYZ, shape (3, 3): (1, 1, 1) is the white, of luminance 1.

    Raises:
        LinAlgError: The primaries lie on a line.
    """
    columns = np.stack([np.array([x, y, 1.0 - x - y]) for x, y in primaries], axis=1)
    return np.asarray(columns * np.linalg.solve(columns, xyz_of_xy(white)))


def xyz_from_rgb(space: ColorSpace) -> FloatArray:
    """Matrix from linear light in the space to XYZ, shape (3, 3); its white has luminance 1."""
    return xyz_of_primaries(space.primaries, space.white)


def decoded(values: NDArray[np.float32], name: str) -> NDArray[np.float32]:
    """Decodes values of a colour space to linear light."""
    curve = COLOR_SPACES[name].curve
    if curve is None:
        return values
    g, a, b, c, d = curve
    high = np.maximum(np.float32(a) * values + np.float32(b), 0) ** np.float32(g)
    return np.where(values >= d, high, np.float32(c) * values).astype(np.float32)


def encoded(linear: NDArray[np.float64], name: str) -> NDArray[np.float64]:
    """Encodes linear light in a colour space; the inverse of ``decoded``."""
    curve = COLOR_SPACES[name].curve
    if curve is None:
        return linear
    g, a, b, c, d = curve
    high = (np.maximum(linear, 0) ** (1 / g) - b) / a
    return np.where(linear >= c * d, high, linear / c)
