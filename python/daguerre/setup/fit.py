"""Quality of a polynomial lens against the tolerance of a camera."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import daguerre._core as _core
from daguerre.camera.camera import Camera
from daguerre.camera.parameters import CAMERA

DEFAULT_DEGREE: int = CAMERA["degree"].usual
DEFAULT_TOLERANCE: float = CAMERA["fit_tolerance"].usual


@dataclass(frozen=True)
class FitQuality:
    """Quality of a polynomial lens over its film.

    Attributes:
        degree: Degree of the polynomials.
        rms_um: RMS error on the film.
        rms_px: RMS error in pixels.
        largest_um: Largest error on the film.
        used: Whether the polynomials draw; otherwise they miss the tolerance, and the exact lens
            draws.
        note: Quality in a sentence.
    """

    degree: int
    rms_um: float
    rms_px: float
    largest_um: float
    used: bool
    note: str

    @property
    def facts(self) -> dict[str, Any]:
        """Errors for metadata and hashes."""
        return {
            "fit_degree": self.degree,
            "fit_error_um": self.rms_um,
            "fit_error_px": self.rms_px,
            "fit_largest_error_um": self.largest_um,
        }


def judged(lens: _core.ExactLens, camera: Camera, name: str, pitch_mm: float) -> FitQuality:
    """Judges whether the polynomials of a lens meet a camera's tolerance.

    Args:
        lens: Lens with a fit.
        camera: Camera, for the tolerance.
        name: Name of the lens, for the note.
        pitch_mm: Pixel pitch, mm.
    """
    fit = lens.fit
    assert fit is not None
    tolerance = DEFAULT_TOLERANCE if camera.fit_tolerance is None else camera.fit_tolerance
    um = pitch_mm * 1e3
    whole = fit.error.all.film
    said = (
        f"the fit of {name} to degree {fit.degree} is off by {_length(whole.rms)} RMS on the film"
    )
    lit = [zone for zone in fit.error.zones if zone.rays]
    worst = max(lit, key=lambda zone: zone.film.rms)
    good = worst.film.rms <= tolerance * um
    if good:
        note = f"{said}, {whole.rms / um:.2g} px"
    else:
        angles = [_field_deg(lens.without_fit(), worst.low, r) for r in (worst.low, worst.high)]
        note = (
            f"{said}, and {_length(worst.film.rms)} or {worst.film.rms / um:.2g} px at "
            f"{worst.low:.3g} to {worst.high:.3g} mm from the middle ({angles[0]:.0f} to "
            f"{angles[1]:.0f} degrees off the axis), beyond the {tolerance:g} px of "
            "fit_tolerance: the exact lens draws instead"
        )
    return FitQuality(fit.degree, whole.rms, whole.rms / um, whole.max, good, note)


def _length(um: float) -> str:
    return f"{um:.2g} um" if um < 1000 else f"{um / 1000:.2g} mm"


def _field_deg(exact: _core.ExactLens, inner_mm: float, radius_mm: float) -> float:
    """View angle of a film point, deg; of the outermost lit point if this point is dark."""
    angle = 0.0
    for step in range(9):
        x, y, z = exact.chief_direction(radius_mm - (radius_mm - inner_mm) * step / 8, 0.0)
        angle = math.degrees(math.atan2(math.hypot(x, y), -z))
        if angle > 0:
            break
    return angle
