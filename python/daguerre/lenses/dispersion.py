"""Takes the dispersion away from a lens: its glass then bends all colours alike."""

from __future__ import annotations

from .lens import DESIGN_WAVELENGTH_NM, Lens
from .medium import Medium


def without_dispersion(lens: Lens) -> Lens:
    """Returns the lens with media that have their index at 587.56 nm at all wavelengths.

    Focal length and f-number, which belong to that line, stay the same. Absorption and coatings
    keep their colours.
    """
    surfaces = [s.replaced(medium=_constant(s.medium)) for s in lens.surfaces]
    return lens.rebuilt(surfaces, object_medium=_constant(lens.object_medium))


def _constant(medium: Medium) -> Medium:
    """A medium with one index, relative to air as ``Medium.index`` is."""
    return Medium("constant", (medium.index(DESIGN_WAVELENGTH_NM),), absorption=medium.absorption)
