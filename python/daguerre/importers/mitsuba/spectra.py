"""Colours and spectra: numbers, sRGB, samples, files, blackbodies, and plugins for each.

One unit of Mitsuba's radiance is 1 cd/m2, and likewise cd of intensity and lux of irradiance. Its
colours are linear sRGB, as ours; a light of value 1 has the shape of D65 in both. Sampled emission
of 1 at all wavelengths has a luminance of 1 in Mitsuba, and so here.

Source: Mitsuba 3, documentation of spectra, and ``spectrum_from_file`` for the format of files.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb
from daguerre.color.illuminants import blackbody
from daguerre.color.spectra import rgb_of_emission, rgb_of_reflectance
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.scene.materials import Color
from daguerre.scene.spectrum import Spectrum

from .ledger import Entry
from .node import Node, Property
from .numbers import MAX_NUMBERS, numbers, words

#: Wavelengths at which a blackbody is sampled, nm.
_PLANCK_NM = np.linspace(360.0, 830.0, 95)
_MOST_FILE = 1 << 24
#: Luminance of red, green and blue in Mitsuba.
LUMINANCE = (0.212671, 0.715160, 0.072169)
#: Plugins that are colours or spectra, not textures.
PLUGINS = (
    *("rgb", "srgb", "uniform", "regular", "irregular", "d65", "blackbody"),
    *("rawconstant", "srgb_d65", "acromatic"),
)
ReadFile = Callable[[str, Entry], bytes | None]


class _Missing(Exception):
    """A file of samples that does not exist."""


class Spectra:
    """Reads colours and spectra.

    Args:
        read: Reads the file of a name, for an element; None: no such file.
        notes: Receives notes on missing files.
    """

    def __init__(self, read: ReadFile, notes: Notes) -> None:
        self._read, self._notes = read, notes

    def value(self, found: Property) -> Color | Spectrum | None:
        """Colour or spectrum of a property, which is no texture; None, and a note: no such file.

        Raises:
            InputError: The property is no colour or spectrum.
        """
        found.take()
        try:
            made = self._plain(found) if found.tag != "object" else self._node(found.value)
        except _Missing as missing:
            self._notes.add("a spectrum whose file is missing is left out", name=str(missing))
            return None
        values = made.values if isinstance(made, Spectrum) else made
        if min(values) < 0:
            found.entry.fail(f"wanted values of at least 0, got {min(values):g}")
        return made

    def _plain(self, found: Property) -> Color | Spectrum:
        if found.tag in ("float", "integer"):
            return _grey(float(found.value))
        if found.tag == "rgb":
            r, g, b = found.value
            return r, g, b
        if found.tag == "srgb":
            return _linear(found.value)
        if found.tag == "spectrum":
            text, file = found.value
            return self._text(text, file, found.entry)
        if found.tag == "blackbody":
            kelvin, scale = found.value
            return glowing(kelvin, scale, found.entry)
        found.wrong("a colour or spectrum")

    def _text(self, text: str, file: str, entry: Entry) -> Color | Spectrum:
        """Constant, or pairs ``wavelength:value``, or a file of such pairs."""
        if file:
            return self._of_file(file, entry)
        if ":" not in text:
            found = numbers(text, entry, 1, 3)
            return found if len(found) == 3 else _grey(found[0])
        pairs = [numbers(word.replace(":", " "), entry, 2) for word in words(text)]
        return sampled([p[0] for p in pairs], [p[1] for p in pairs], entry)

    def _of_file(self, file: str, entry: Entry) -> Spectrum:
        """Pairs of a wavelength and a value, a pair on each line."""
        about = entry.about(file)
        data = self._read(file, entry)
        if data is None:
            raise _Missing(file)
        lines = _lines(data, about)
        pairs = [numbers(line, about, 2) for line in lines if line.split()]
        return sampled([p[0] for p in pairs], [p[1] for p in pairs], about)

    def _node(self, node: Node) -> Color | Spectrum:
        node.use()
        if node.plugin in ("rgb", "srgb", "srgb_d65"):
            node.skip("unbounded")
            return self._color(node)
        if node.plugin in ("uniform", "acromatic", "rawconstant"):
            node.skip("wavelength_min", "wavelength_max", "lambda_min", "lambda_max")
            return _grey(node.number("value", 1.0))
        if node.plugin == "d65":
            scale = node.number("scale", 1.0)
            color = self._color(node) if node.has("color") else _grey(1.0)
            r, g, b = (scale * c for c in color)
            return r, g, b
        if node.plugin == "blackbody":
            if not node.has("temperature"):
                node.fail("the property 'temperature' is missing")
            node.skip("wavelength_min", "wavelength_max", "lambda_min", "lambda_max")
            temperature = node.number("temperature", 0.0, above=0)
            return glowing(temperature, node.number("scale", 1.0), node.entry)
        return self._samples(node)

    def _color(self, node: Node) -> Color:
        found = node.find("color") or node.find("value")
        if found is None:
            node.fail("the property 'value' is missing")
        if found.tag not in ("rgb", "srgb", "float", "integer"):
            found.wrong("a colour")
        made = self._plain(found)
        found.take()
        assert not isinstance(made, Spectrum)
        return made

    def _samples(self, node: Node) -> Spectrum:
        """Samples of ``regular`` and ``irregular`` spectra."""
        if node.has("filename"):
            return self._of_file(node.text("filename"), node.entry)
        values = numbers(node.text("values"), node.entry)
        if node.plugin == "irregular":
            return sampled(numbers(node.text("wavelengths"), node.entry), values, node.entry)
        low = node.number("wavelength_min", 360.0, above=0)
        high = node.number("wavelength_max", 830.0, above=0)
        return sampled(np.linspace(low, high, max(len(values), 1)), values, node.entry)


def sampled(wavelengths: object, values: object, entry: Entry) -> Spectrum:
    """Spectrum of samples.

    Raises:
        InputError: The values are no spectrum.
    """
    nm = np.asarray(wavelengths, np.float64)
    row = np.asarray(values, np.float64)
    if len(nm) > MAX_NUMBERS or len(nm) != len(row):
        entry.fail(f"wanted as many values as wavelengths, got {len(row)} and {len(nm)}")
    try:
        return Spectrum(tuple(nm.tolist()), tuple(row.tolist()))
    except InputError as error:
        entry.fail(str(error).removeprefix("spectrum: "))


def glowing(kelvin: float, scale: float, entry: Entry) -> Spectrum:
    """Radiance of a blackbody, W / (m2 sr nm), times a factor."""
    if not 0 < kelvin < 1e9:
        entry.fail(f"wanted a temperature above 0 K, got {kelvin:g}")
    return sampled(_PLANCK_NM, scale * blackbody(_PLANCK_NM, kelvin), entry)


def emitted_rgb(value: Color | Spectrum) -> Color:
    """Emission as linear Rec.709; colours beyond it lose their negative part."""
    if not isinstance(value, Spectrum):
        return value
    return _clipped(rgb_of_emission(value.at))


def reflected_rgb(value: Color | Spectrum) -> Color:
    """Reflectance as linear Rec.709, in light of D65."""
    if not isinstance(value, Spectrum):
        return value
    return _clipped(rgb_of_reflectance(value.at))


def _clipped(rgb: NDArray[np.float64]) -> Color:
    r, g, b = (max(float(c), 0.0) for c in rgb)
    return r, g, b


def _grey(value: float) -> Color:
    return value, value, value


def _linear(encoded: Color) -> Color:
    r, g, b = srgb.to_linear(np.array(encoded, np.float32)).tolist()
    return r, g, b


def _lines(data: bytes, entry: Entry) -> list[str]:
    """Lines of a file of samples, without comments."""
    if len(data) > _MOST_FILE:
        entry.fail(f"wanted at most {_MOST_FILE} bytes, got {len(data)}")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        entry.fail("wanted a text file of samples")
    return [line.split("#")[0] for line in text.splitlines()]


def luminance(color: Color) -> float:
    """Luminance of linear Rec.709."""
    return math.fsum(w * c for w, c in zip(LUMINANCE, color, strict=True))
