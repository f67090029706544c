"""Media on their way out: coefficients as colours."""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.files.notes import Notes
from daguerre.scene.media import Medium
from daguerre.scene.spectrum import Spectrum

from .spectra import Color, rgb_of


@dataclass(frozen=True)
class PlainMedium:
    """An even medium: coefficients, 1/m, and the lobes of its phase function."""

    absorption: Color
    scattering: Color
    lobes: tuple[tuple[float, float], ...]
    emission: Color

    @property
    def extinction(self) -> Color:
        """Sum of absorption and scattering, 1/m."""
        (a, b, c), (d, e, f) = self.absorption, self.scattering
        return a + d, b + e, c + f


def plain_medium(medium: Medium | None, notes: Notes) -> PlainMedium | None:
    """Simplifies a medium, and notes parts that no other renderer reads; None: a vacuum."""
    if medium is None:
        return None
    if medium.density is not None:
        notes.add("density grid of a medium is left out: the medium is homogeneous, with density 1")
    values = []
    for value in (medium.absorption, medium.scattering, medium.emission):
        if isinstance(value, Spectrum):
            notes.add("spectrum of a medium is written as a colour")
            value = rgb_of(value)
        values.append(value)
    absorption, scattering, emission = values
    lobes = tuple((g, weight) for g, weight in medium.lobes if weight > 0)
    made = PlainMedium(absorption, scattering, lobes, emission)
    return made if max(made.extinction) > 0 or max(emission) > 0 else None
