"""Encodings of colours in files, by name or by primaries: curve, and matrix to linear Rec.709.

Whites are adapted by Bradford's matrix (:mod:`.adaptation`), so that white stays white.

Source: MaterialX specification 1.39, "Color Spaces and Color Management Systems"; Color Interop
Forum, "Color Space Encodings for Texture Assets and CG Rendering"; Adobe RGB (1998) Color Image
Encoding.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from . import srgb
from .adaptation import BRADFORD, adaptation
from .illuminants import D65_STATED, xyz_of_xy
from .spaces import (
    ACES_WHITE,
    AP0,
    AP1,
    COLOR_SPACES,
    E_WHITE,
    P3,
    P709,
    P2020,
    XY,
    XYZ,
    xyz_of_primaries,
)

FloatArray = NDArray[np.float64]
_ADOBE = ((0.64, 0.33), (0.21, 0.71), (0.15, 0.06))
_ADOBE_GAMMA = 563 / 256
#: Differences of chromaticities that are rounding, in the digits that files state.
ROUNDING, _E_ROUNDING = 2e-4, 5e-4
#: Least area of a triangle of primaries in the plane of x and y; Rec.709's is 0.112.
_LEAST_AREA = 1e-3


@dataclass(frozen=True)
class Encoding:
    """How the numbers of a colour mean light.

    Attributes:
        srgb: Whether they are encoded by sRGB's curve.
        gamma: Exponent that decodes them, if not.
        primaries: Chromaticities of red, green and blue.
        white: Chromaticity of (1, 1, 1).
        neutral: Chromaticity that is white in the scene; None: ``white``.
    """

    srgb: bool = False
    gamma: float = 1.0
    primaries: tuple[XY, ...] = P709
    white: XY = D65_STATED
    neutral: XY | None = None

    @property
    def scene_white(self) -> XY:
        """Chromaticity that is white in the scene."""
        return self.neutral or self.white

    @property
    def is_plain(self) -> bool:
        """Whether the numbers are linear Rec.709, at most encoded by sRGB's curve."""
        return self.gamma == 1.0 and self.is_rec709

    @property
    def is_rec709(self) -> bool:
        """Whether primaries and white are Rec.709's, to the digits that files state."""
        return _near((*self.primaries, self.white), (*P709, D65_STATED), ROUNDING)

    @property
    def is_linear(self) -> bool:
        """Whether the numbers are proportional to light."""
        return self.gamma == 1.0 and not self.srgb


def _near(some: tuple[XY, ...], others: tuple[XY, ...], within: float) -> bool:
    return bool(np.allclose(some, others, rtol=0, atol=within))


LINEAR, SRGB = Encoding(), Encoding(srgb=True)
XYZ_D65 = Encoding(primaries=XYZ, white=E_WHITE, neutral=D65_STATED)
#: XYZ in which (1, 1, 1) is white.
XYZ_E = Encoding(primaries=XYZ, white=E_WHITE)
_BY_NAME = {
    LINEAR: "lin_rec709 lin_rec709_scene lin_srgb linear raw data none identity unknown",
    SRGB: "srgb_texture srgb srgb_rec709_scene srgb_rec709_display",
    Encoding(gamma=2.2): "g22_rec709 g22_rec709_scene gamma22",
    Encoding(gamma=1.8): "g18_rec709 g18_rec709_scene gamma18",
    Encoding(gamma=2.4): "rec709_display g24_rec709 g24_rec709_scene gamma24",
    Encoding(primaries=AP0, white=ACES_WHITE): "lin_ap0 lin_ap0_scene aces2065_1",
    Encoding(primaries=AP1, white=ACES_WHITE): "acescg lin_ap1 lin_ap1_scene",
    Encoding(gamma=2.2, primaries=AP1, white=ACES_WHITE): "g22_ap1 g22_ap1_scene",
    Encoding(srgb=True, primaries=AP1, white=ACES_WHITE): "srgb_ap1 srgb_ap1_scene",
    Encoding(primaries=P3): "lin_displayp3 lin_p3d65 lin_p3d65_scene",
    Encoding(srgb=True, primaries=P3): "srgb_displayp3 srgb_p3d65 srgb_p3d65_scene",
    Encoding(primaries=P2020): "lin_rec2020 lin_rec2020_scene",
    Encoding(gamma=2.4, primaries=P2020): "g24_rec2020 g24_rec2020_scene",
    Encoding(primaries=_ADOBE): "lin_adobergb lin_adobergb_scene",
    Encoding(gamma=_ADOBE_GAMMA, primaries=_ADOBE): "adobergb g22_adobergb g22_adobergb_scene",
    XYZ_D65: "lin_ciexyzd65 lin_ciexyzd65_scene",
}
ENCODINGS = {name: encoding for encoding, names in _BY_NAME.items() for name in names.split()}
#: Names of numbers that are no colours, which nothing converts.
_NO_COLORS = ("raw", "data", "none", "identity")
#: Other names that programs write into files, in lower case, with their words joined by "_".
_IN_FILES = {
    "scene_linear": "lin_rec709",
    "scene_linear_rec.709_srgb": "lin_rec709",
    "linear_rec.709": "lin_rec709",
    "linear_rec.709_(srgb)": "lin_rec709",
    "linear_srgb": "lin_rec709",
    "utility___linear___srgb": "lin_rec709",
    "utility___linear___rec.709": "lin_rec709",
    "utility___linear___rec.2020": "lin_rec2020",
    "utility___linear___p3_d65": "lin_p3d65",
    "linear_rec.2020": "lin_rec2020",
    "linear_p3_d65": "lin_p3d65",
    "linear_dci_p3_d65": "lin_p3d65",
    "linear_adobergb": "lin_adobergb",
    "aces2065_1": "lin_ap0",
    "aces": "lin_ap0",
    "aces___aces2065_1": "lin_ap0",
    "aces___acescg": "lin_ap1",
    "linear_cie_xyz_d65": "lin_ciexyzd65",
    "cie_xyz_d65___scene_referred": "lin_ciexyzd65",
}


def is_data(name: str) -> bool:
    """Whether a colour space says that numbers are no colours."""
    return name.lower() in _NO_COLORS


def encoding_of(name: str) -> Encoding | None:
    """Encoding of a colour space; None: its name is unknown. No name is linear Rec.709."""
    return ENCODINGS.get(name.lower().replace("-", "_")) if name else LINEAR


def encoding_in_file(name: str) -> Encoding | None:
    """Encoding of a name that a file states, as programs spell it; None: it is unknown."""
    plain = name.strip().lower().replace(" ", "_").replace("-", "_")
    return encoding_of(_IN_FILES.get(plain, plain)) if plain else None


def encoding_of_primaries(primaries: tuple[XY, ...], white: XY) -> Encoding:
    """Encoding of linear light by its primaries and white.

    Primaries of XYZ with white E state nothing but XYZ itself: that white is only how the format
    says that (1, 1, 1) is X = Y = Z = 1. They are read as they are, so that D65 is white, as in
    OpenEXR's own test pictures (``Chromaticities/XYZ.exr`` beside ``Rec709.exr``).

    Args:
        primaries: Chromaticities of red, green and blue.
        white: Chromaticity of (1, 1, 1).

    Raises:
        ValueError: They make no colour space; the text is the reason.
    """
    numbers = np.array([*primaries, white], np.float64)
    if not (np.isfinite(numbers).all() and np.abs(numbers).max() <= 10):
        raise ValueError("they are not finite numbers")
    (a, b, c), w = numbers[:3], numbers[3]
    area = abs(float((b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0])) / 2
    if area < _LEAST_AREA:
        raise ValueError("the primaries lie on a line")
    if not (w[0] > 0 and w[1] > 0.01 and w.sum() < 1 and (BRADFORD @ xyz_of_xy(white) > 0).all()):
        raise ValueError("the white is not a color")
    if (
        np.linalg.solve(np.stack([numbers[:3, 0], numbers[:3, 1], np.ones(3)]), [*w, 1]) <= 0
    ).any():
        raise ValueError("the white lies outside of the primaries")
    if _near(primaries, XYZ, ROUNDING) and _near((white,), (E_WHITE,), _E_ROUNDING):
        return XYZ_D65
    return Encoding(primaries=primaries, white=white)


_TITLES = {
    P709: "Rec.709", P3: "P3", P2020: "Rec.2020", AP0: "ACES AP0", AP1: "ACES AP1",
    XYZ: "CIE XYZ", _ADOBE: "Adobe RGB",
}  # fmt: skip
_WHITES = {D65_STATED: "D65", ACES_WHITE: "ACES", E_WHITE: "E"}


def title_of(encoding: Encoding) -> str:
    """Describes an encoding in notes: by known names, else by chromaticities."""
    close = (name for known, name in _TITLES.items() if _near(encoding.primaries, known, ROUNDING))
    corners = " ".join(f"{x:.4g},{y:.4g}" for x, y in encoding.primaries)
    white = encoding.scene_white
    near = (name for xy, name in _WHITES.items() if _near((white,), (xy,), _E_ROUNDING))
    title = f"{next(close, f'primaries {corners}')}"
    title += f", white {next(near, f'{white[0]:.4g},{white[1]:.4g}')}"
    if encoding.srgb:
        return f"{title}, encoded by sRGB's curve"
    return title if encoding.is_linear else f"{title}, gamma {encoding.gamma:.4g}"


@cache
def rec709_from(encoding: Encoding) -> tuple[tuple[float, float, float], ...]:
    """Matrix from linear light in a space to linear Rec.709, by rows."""
    from_rgb = xyz_of_primaries(encoding.primaries, encoding.white)
    xyz = adaptation(encoding.scene_white, D65_STATED) @ from_rgb
    matrix = np.linalg.solve(xyz_of_primaries(P709, D65_STATED), xyz)
    return tuple((float(r), float(g), float(b)) for r, g, b in matrix)


def encoding_of_space(name: str) -> Encoding:
    """Encoding of the linear light of a space of ``spaces.COLOR_SPACES``."""
    space = COLOR_SPACES[name]
    return Encoding(primaries=space.primaries, white=space.white, neutral=space.neutral)


def linear(values: NDArray[np.float32], encoding: Encoding) -> NDArray[np.float32]:
    """Undoes the curve of an encoding; negative numbers mirror it, as in extended spaces."""
    if encoding.is_linear:
        return values
    size = np.abs(values)
    found = srgb.to_linear(size) if encoding.srgb else size ** np.float32(encoding.gamma)
    return np.asarray(np.copysign(found, values), np.float32)


def curved(light: NDArray[np.float32], encoding: Encoding) -> NDArray[np.float32]:
    """Encodes linear light by the curve of an encoding; the inverse of :func:`linear`."""
    if encoding.is_linear:
        return light
    size = np.abs(light)
    found = srgb.from_linear(size) if encoding.srgb else size ** np.float32(1 / encoding.gamma)
    return np.asarray(np.copysign(found, light), np.float32)


def through(values: NDArray[np.float32], matrix: FloatArray) -> NDArray[np.float32]:
    """Multiplies colours, shape (..., 3), by a matrix in the precision of floats."""
    with np.errstate(invalid="ignore", over="ignore"):  # of NaN and infinite values
        return np.asarray(values @ np.asarray(matrix, np.float32).T)
