"""Sampled spectra on their way out: as numbers by wavelength, or as colours."""

from __future__ import annotations

from daguerre.color.spectra import rgb_of_reflectance
from daguerre.scene.spectrum import Spectrum

Color = tuple[float, float, float]
#: First and last wavelength of written spectra, nm: other renderers assume 0 beyond the samples.
_FIRST_NM, _LAST_NM = 360.0, 830.0
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
    red, green, blue = (max(float(c), 0.0) for c in rgb_of_reflectance(spectrum.at))
    return red, green, blue


def steps_of(color: Color) -> Spectrum:
    """Spectrum of steps, for parameters that a file holds by wavelength alone."""
    red, green, blue = color
    edge = 1e-3
    nm = (_BLUE_NM, _BLUE_NM + edge, _RED_NM, _RED_NM + edge)
    return Spectrum(nm, (blue, green, green, red))
