"""Colour spaces by the names of USD, MaterialX and OpenColorIO: curve and matrix to Rec.709.

Source: MaterialX specification 1.39, "Color Spaces and Color Management Systems"; Color Interop
Forum, "Color Space Encodings for Texture Assets and CG Rendering"; SMPTE ST 2065-1 (AP0);
Academy S-2014-004 (AP1); Adobe RGB (1998) Color Image Encoding. Whites are adapted by Bradford.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from daguerre.color.adaptation import adaptation
from daguerre.color.illuminants import D65_STATED, xyz_of_xy
from daguerre.color.spaces import COLOR_SPACES, P709

FloatArray = NDArray[np.float64]
_ACES_WHITE = (0.32168, 0.33767)
_AP0 = ((0.7347, 0.2653), (0.0, 1.0), (0.0001, -0.0770))
_AP1 = ((0.713, 0.293), (0.165, 0.830), (0.128, 0.044))
_ADOBE = ((0.64, 0.33), (0.21, 0.71), (0.15, 0.06))
_ADOBE_GAMMA = 563 / 256
_P3 = COLOR_SPACES["p3"].primaries
_P2020 = COLOR_SPACES["rec2020"].primaries


@dataclass(frozen=True)
class Encoding:
    """How the numbers of a colour mean light.

    Attributes:
        srgb: Whether they are encoded by sRGB's curve.
        gamma: Exponent that decodes them, if not.
        primaries: Chromaticities of red, green and blue.
        white: Chromaticity of white.
    """

    srgb: bool = False
    gamma: float = 1.0
    primaries: tuple[tuple[float, float], ...] = P709
    white: tuple[float, float] = D65_STATED

    @property
    def is_plain(self) -> bool:
        """Whether the numbers are linear Rec.709, at most encoded by sRGB's curve."""
        return self.gamma == 1.0 and self.primaries == P709


_LINEAR, _SRGB = Encoding(), Encoding(srgb=True)
_BY_NAME = {
    _LINEAR: "lin_rec709 lin_rec709_scene lin_srgb linear raw data none identity unknown",
    _SRGB: "srgb_texture srgb srgb_rec709_scene srgb_rec709_display",
    Encoding(gamma=2.2): "g22_rec709 g22_rec709_scene gamma22",
    Encoding(gamma=1.8): "g18_rec709 g18_rec709_scene gamma18",
    Encoding(gamma=2.4): "rec709_display g24_rec709 g24_rec709_scene gamma24",
    Encoding(primaries=_AP0, white=_ACES_WHITE): "lin_ap0 lin_ap0_scene aces2065_1",
    Encoding(primaries=_AP1, white=_ACES_WHITE): "acescg lin_ap1 lin_ap1_scene",
    Encoding(gamma=2.2, primaries=_AP1, white=_ACES_WHITE): "g22_ap1 g22_ap1_scene",
    Encoding(srgb=True, primaries=_AP1, white=_ACES_WHITE): "srgb_ap1 srgb_ap1_scene",
    Encoding(primaries=_P3): "lin_displayp3 lin_p3d65 lin_p3d65_scene",
    Encoding(srgb=True, primaries=_P3): "srgb_displayp3 srgb_p3d65 srgb_p3d65_scene",
    Encoding(primaries=_P2020): "lin_rec2020 lin_rec2020_scene",
    Encoding(gamma=2.4, primaries=_P2020): "g24_rec2020 g24_rec2020_scene",
    Encoding(primaries=_ADOBE): "lin_adobergb lin_adobergb_scene",
    Encoding(gamma=_ADOBE_GAMMA, primaries=_ADOBE): "adobergb g22_adobergb g22_adobergb_scene",
}
ENCODINGS = {name: encoding for encoding, names in _BY_NAME.items() for name in names.split()}


def encoding_of(name: str) -> Encoding | None:
    """Encoding of a colour space; None: its name is unknown. No name is linear Rec.709."""
    return ENCODINGS.get(name.lower().replace("-", "_")) if name else _LINEAR


@cache
def rec709_from(encoding: Encoding) -> tuple[tuple[float, float, float], ...]:
    """Matrix from linear light in a space to linear Rec.709, by rows."""
    xyz = adaptation(encoding.white, D65_STATED) @ _xyz_from(encoding.primaries, encoding.white)
    matrix = np.linalg.solve(_xyz_from(P709, D65_STATED), xyz)
    return tuple((float(r), float(g), float(b)) for r, g, b in matrix)


def _xyz_from(primaries: tuple[tuple[float, float], ...], white: tuple[float, float]) -> FloatArray:
    columns = np.stack([np.array([x, y, 1.0 - x - y]) for x, y in primaries], axis=1)
    return np.asarray(columns * np.linalg.solve(columns, xyz_of_xy(white)))
