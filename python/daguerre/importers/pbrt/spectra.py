"""Reads spectra and colors of parameters.

A light's color in pbrt-v4 has a luminance that ``scale`` alone sets: a spectrum of any size has
1 cd/m2, and an RGB triple the luminance of its numbers under the white of its color space. In
pbrt-v3 spectra are used as they are, relative to a constant spectrum of 1.

Source: pbrt-v4's user's guide ("Spectrum parameters"), and ``SpectrumToPhotometric`` of its code.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.color.adaptation import adaptation
from daguerre.color.illuminants import D65_XY, NM, blackbody, observer, planck, xyz_of_xy
from daguerre.color.spectra import luminance_of_rgb, rgb_from_xyz, rgb_of_reflectance
from daguerre.errors import InputError, asked_by
from daguerre.files.notes import Notes
from daguerre.files.text_lines import text_of

from .files import Files
from .parameters import Parameter

FloatArray = NDArray[np.float64]
Color = tuple[float, float, float]
WHITE: Color = (1.0, 1.0, 1.0)
#: Primaries and white of color spaces: ITU-R BT.2020-2; SMPTE EG 432-1; SMPTE ST 2065-1.
_SPACES = {
    "rec2020": ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), D65_XY),
    "dci-p3": ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), D65_XY),
    "aces2065-1": ((0.7347, 0.2653), (0.0, 1.0), (0.0001, -0.077), (0.32168, 0.33767)),
}
#: Chromaticities of named illuminants (CIE 015:2018; SMPTE ST 2065-1).
_ILLUMINANTS = {
    "stdillum-A": (0.44758, 0.40745),
    "stdillum-D50": (0.34567, 0.35851),
    "illum-acesD60": _SPACES["aces2065-1"][3],
    "stdillum-D65": D65_XY,
}
#: Wavelength of the peak of a black body times its temperature, nm K (Wien's law, CODATA 2018).
_WIEN = 2.897771955e6
_MOST_SAMPLES = 100_000
_MAX_FILE = 16_000_000


@dataclass(frozen=True, eq=False)
class Samples:
    """A spectrum: values at wavelengths, linear between them.

    Attributes:
        nm: Wavelengths, rising, shape (N,).
        values: Values, shape (N,).
    """

    nm: FloatArray
    values: FloatArray

    def zero_beyond(self, nm: FloatArray) -> FloatArray:
        """Values at wavelengths; beyond the ends 0."""
        return np.interp(nm, self.nm, self.values, left=0.0, right=0.0)

    def constant_beyond(self, nm: FloatArray) -> FloatArray:
        """Values at wavelengths; constant beyond the ends."""
        return np.interp(nm, self.nm, self.values)


class Spectra:
    """Reads spectra of a scene.

    Args:
        files: Files of the scene.
        version: Version of pbrt, 3 or 4.
        notes: Receives notes on spectra that are not known.
    """

    def __init__(self, files: Files, version: int, notes: Notes) -> None:
        self._files, self._version, self._notes = files, version, notes
        self._read: dict[Path, Samples] = {}

    def light(self, parameter: Parameter | None) -> Color:
        """Color of a light, as luminance in cd/m2 at a scale of 1; default: white.

        Raises:
            InputError: The parameter is wrong.
        """
        if parameter is None:
            return WHITE
        if parameter.type in ("rgb", "xyz"):
            if (parameter.numbers < 0).any():
                parameter.fail("numbers must be at least 0")
            return _clipped(self._triple(parameter), np.inf)
        if parameter.type == "blackbody":
            return self._blackbody(parameter)
        name = _name(parameter)
        if name in _ILLUMINANTS:
            return _visible(xyz_of_xy(_ILLUMINANTS[name]))
        samples = self.samples(parameter)
        if samples is None:
            return WHITE
        return _of_radiance(samples.zero_beyond(NM), self._version)

    def coefficient(self, parameter: Parameter) -> Color:
        """Numbers of at least 0 for red, green and blue: a reflectance, or a coefficient of media.

        A spectrum gets the color that it has as a reflectance under D65.
        """
        if parameter.type in ("rgb", "xyz"):
            return _clipped(self._triple(parameter), np.inf)
        if parameter.type == "blackbody":
            return _clipped(self._blackbody(parameter), np.inf)
        samples = self.samples(parameter)
        if samples is None:
            return (0.5, 0.5, 0.5)
        return _clipped(rgb_of_reflectance(samples.constant_beyond), np.inf)

    def samples(self, parameter: Parameter) -> Samples | None:
        """Samples of a spectrum, from numbers or a file; None, and a note: the name is not known.

        Raises:
            InputError: The samples are wrong.
        """
        if isinstance(parameter.values, np.ndarray):
            with asked_by(parameter.place):
                return _samples(parameter.numbers, parameter.name)
        name = _name(parameter)
        if not name:
            parameter.fail("wanted one name")
        path = self._files.find(name, parameter.place, parameter.name)
        if path is None:
            is_file = "/" in name or "." in name
            what = (
                "whose file is missing is left out"
                if is_file
                else "with an unknown name is left out"
            )
            self._notes.add(f"a spectrum {what}", name=name)
            return None
        if path not in self._read:
            with asked_by(f"{parameter.place}: {parameter.name}"):
                self._read[path] = self._of_file(path)
        return self._read[path]

    def _of_file(self, path: Path) -> Samples:
        words = [
            word
            for line in text_of(path, most=_MAX_FILE).splitlines()
            for word in line.split("#")[0].split()
        ]
        try:
            numbers = np.array([float(word) for word in words], np.float64)
        except ValueError:
            raise InputError(f"{path}: wanted numbers only") from None
        return _samples(numbers, str(path))

    def _triple(self, parameter: Parameter) -> Color:
        numbers = parameter.numbers
        if len(numbers) != 3:
            parameter.fail(f"wanted 3 numbers, got {len(numbers)}")
        if parameter.type == "xyz":
            return _color(rgb_from_xyz() @ numbers)
        if parameter.color_space == "srgb":
            return _color(numbers)
        return _color(to_rec709(parameter.color_space) @ numbers)

    def _blackbody(self, parameter: Parameter) -> Color:
        numbers = parameter.numbers
        if len(numbers) not in (1, 2):
            parameter.fail(f"wanted a temperature, K, got {len(numbers)} numbers")
        kelvin = float(numbers[0])
        if not 100 <= kelvin <= 1e6:
            parameter.fail(f"wanted 100 .. 1e6 K, got {kelvin:g}")
        if self._version == 4:
            return _of_radiance(planck(kelvin), None)
        scale = float(numbers[1]) if len(numbers) == 2 else 1.0
        peak = blackbody(np.array([_WIEN / kelvin]), kelvin)
        return _of_radiance(blackbody(NM, kelvin) / peak * scale, self._version)


def to_rec709(space: str) -> FloatArray:
    """Matrix from linear light of a color space to Rec.709, shape (3, 3); its white stays white."""
    *primaries, white = _SPACES[space]
    columns = np.stack([xyz_of_xy(primary) for primary in primaries], axis=1)
    xyz = columns * np.linalg.solve(columns, xyz_of_xy(white))
    return np.asarray(rgb_from_xyz() @ adaptation(white, D65_XY) @ xyz)


def scaled(color: Color, factor: float) -> Color:
    """Product of a color and a number."""
    return color[0] * factor, color[1] * factor, color[2] * factor


def luminance(color: Color) -> float:
    """Luminance of a color."""
    return float(luminance_of_rgb() @ np.asarray(color))


def _name(parameter: Parameter) -> str:
    """Name of a spectrum; empty: it is given by numbers."""
    if isinstance(parameter.values, np.ndarray) or len(parameter.values) != 1:
        return ""
    return str(parameter.values[0])


def _samples(numbers: FloatArray, where: str) -> Samples:
    if len(numbers) < 2 or len(numbers) % 2 or len(numbers) > 2 * _MOST_SAMPLES:
        raise InputError(
            f"{where}: wanted pairs of wavelength and value, got {len(numbers)} numbers"
        )
    nm, values = numbers.reshape(-1, 2).T
    if not (np.diff(nm) > 0).all():
        raise InputError(f"{where}: wavelengths must increase")
    if not np.isfinite(numbers).all():
        raise InputError(f"{where}: numbers must be finite")
    return Samples(nm.copy(), values.copy())


def _of_radiance(radiance: FloatArray, version: int | None) -> Color:
    """Color of a spectrum at ``NM``: of luminance 1, or for pbrt-v3 relative to a constant of 1."""
    xyz = radiance @ observer()
    whole = float(observer()[:, 1].sum()) if version == 3 else float(xyz[1])
    if not whole > 0:
        return (0.0, 0.0, 0.0)
    return _visible(xyz / whole)


def _visible(xyz: FloatArray) -> Color:
    """RGB of at least 0 with the luminance of XYZ."""
    rgb = np.maximum(_rgb(xyz), 0.0)
    now = float(luminance_of_rgb() @ rgb)
    return _color(rgb * (float(xyz[1]) / now) if now > 0 else rgb)


def _rgb(xyz: FloatArray) -> FloatArray:
    return np.asarray(rgb_from_xyz() @ xyz)


def _clipped(color: FloatArray | Color, high: float) -> Color:
    return _color(np.clip(np.asarray(color, np.float64), 0.0, high))


def _color(rgb: FloatArray) -> Color:
    red, green, blue = (float(value) for value in rgb)
    return red, green, blue
