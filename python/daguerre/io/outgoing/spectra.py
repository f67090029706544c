"""Sampled spectra on their way out: as numbers by wavelength, or as colours."""

from __future__ import annotations

import numpy as np

from daguerre.color.spectra import rgb_mixes
from daguerre.scene.spectrum import Spectrum

Color = tuple[float, float, float]
#: First and last wavelength of written spectra, nm: others take them to be 0 beyond their samples.
_FIRST_NM, _LAST_NM = 360.0, 830.0
#: Wavelengths of sums over D65.
_COUNT = 60
#: Wavelengths, nm, at which blue ends and red begins for an index by colour.
_BLUE_NM, _RED_NM = 490.0, 580.0


def samples(spectrum: Spectrum) -> list[tuple[float, float]]:
    """Wavelengths, nm, and values; constant beyond the first and the last sample."""
    pairs = list(zip(spectrum.wavelengths_nm, spectrum.values, strict=True))
    if pairs[0][0] > _FIRST_NM:
        pairs.insert(0, (_FIRST_NM, pairs[0][1]))
    if pairs[-1][0] < _LAST_NM:
        pairs.append((_LAST_NM, pairs[-1][1]))
    return pairs


def rgb_of(spectrum: Spectrum) -> Color:
    """Linear Rec.709 of a reflectance under D65; not below 0."""
    nm, mixes = rgb_mixes(_COUNT)
    rgb = np.einsum("l,lij->i", spectrum.at(nm), mixes)
    red, green, blue = (float(c) for c in np.maximum(rgb, 0.0))
    return red, green, blue


def steps_of(color: Color) -> Spectrum:
    """Spectrum of steps, for what files hold by wavelength alone."""
    red, green, blue = color
    edge = 1e-3
    nm = (_BLUE_NM, _BLUE_NM + edge, _RED_NM, _RED_NM + edge)
    return Spectrum(nm, (blue, green, green, red))
