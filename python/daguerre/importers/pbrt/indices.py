"""Indices of refraction of glasses and metals, by name, numbers or file."""

from __future__ import annotations

import numpy as np

from daguerre.errors import UsageError
from daguerre.files.notes import Notes
from daguerre.lenses.glasses.catalogue import find as find_glass
from daguerre.scene import metals
from daguerre.scene.spectrum import Spectrum

from .parameters import SPECTRA, Parameter
from .spectra import Color, Samples, Spectra
from .state import Entity

#: Glasses of pbrt by their names in makers' catalogues.
_GLASSES = {"BK7": "N-BK7", "BAF10": "N-BAF10", "FK51A": "N-FK51A", "LASF9": "LASF9"} | {
    name: name for name in ("SF5", "SF10", "SF11")
}
_NM = np.arange(380.0, 781.0, 10.0)
#: Metal without ``eta`` and ``k``.
_METAL = "Cu"


class Indices:
    """Reads indices of refraction.

    Args:
        spectra: Spectra of the scene.
        notes: Receives notes on names that are not known.
    """

    def __init__(self, spectra: Spectra, notes: Notes) -> None:
        self._spectra, self._notes = spectra, notes

    def glass(self, entity: Entity, names: tuple[str, ...], default: float) -> float | Spectrum:
        """Index of a glass: a number, or a spectrum.

        Args:
            entity: Directive.
            names: Names of the parameter; the first that is given counts.
            default: Index without it.
        """
        name = next((name for name in names if entity.parameters.has(name)), names[0])
        found = entity.parameters.find(name, "float", "integer", "texture", *SPECTRA)
        if found is None:
            return default
        if found.type == "texture":
            self._notes.add(f"a texture of {name!r} is read as {default:g}")
            return default
        if found.type in ("float", "integer"):
            return entity.parameters.number(name, default, 0.1, 10.0) or default
        if isinstance(found.values, np.ndarray):
            if found.type == "rgb":
                self._notes.add(f"{name!r} of a glass is read from its green channel")
                return float(min(max(self._spectra.coefficient(found)[1], 1.0), 10.0))
            return _spectrum(found, self._spectra.samples(found), default)
        title = str(found.values[0]).removeprefix("glass-")
        if title in _GLASSES:
            data = find_glass(_GLASSES[title])
            return Spectrum(tuple(_NM.tolist()), tuple(data.index(_NM).tolist()))
        return _spectrum(found, self._spectra.samples(found), default)

    def metal(self, entity: Entity, eta: str, k: str) -> tuple[Color | Spectrum, Color | Spectrum]:
        """Index of a metal, eta + i k; default: copper.

        Args:
            entity: Directive.
            eta: Name of the parameter of the real part.
            k: Name of the parameter of the imaginary part.
        """
        copper = metals.load(_METAL)
        return self._part(entity, eta, copper[0], 0), self._part(entity, k, copper[1], 1)

    def _part(
        self, entity: Entity, name: str, default: Color | Spectrum, part: int
    ) -> Color | Spectrum:
        found = entity.parameters.find(name, "float", "texture", *SPECTRA)
        if found is None:
            return default
        if found.type == "texture":
            self._notes.add(f"a texture of {name!r} of a metal is replaced by copper")
            return default
        if found.type == "float":
            value = entity.parameters.number(name, 1.0, 0.0)
            return (value, value, value)
        if found.type in ("rgb", "xyz"):
            return self._spectra.coefficient(found)
        if not isinstance(found.values, np.ndarray):
            words = str(found.values[0]).split("-")
            if len(words) == 3 and words[0] == "metal":
                return self._named(words[1], default, part)
        samples = self._spectra.samples(found)
        return default if samples is None else _sampled(found, samples)

    def _named(self, title: str, default: Color | Spectrum, part: int) -> Color | Spectrum:
        try:
            return metals.load(title)[part]
        except UsageError:
            self._notes.add(f"the metal {title[:40]!r} is unknown and read as copper")
            return default


def _spectrum(found: Parameter, samples: Samples | None, default: float) -> float | Spectrum:
    if samples is None:
        return default
    if not (samples.values >= 0.1).all():
        found.fail("indices must be at least 0.1")
    return _sampled(found, samples)


def _sampled(found: Parameter, samples: Samples) -> Spectrum:
    if (samples.values < 0).any() or not samples.nm[0] > 0:
        found.fail("wavelengths must be above 0 and values at least 0")
    nm, values = samples.nm, samples.values
    if len(nm) > 4096:
        at = np.linspace(360.0, 830.0, 941)
        nm, values = at, samples.constant_beyond(at)
    return Spectrum(tuple(nm.tolist()), tuple(values.tolist()))
