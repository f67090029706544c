"""Whether a polynomial lens is as good as a camera asks for."""

from __future__ import annotations

import math
from typing import Any

import daguerre._core as _core
from daguerre.camera.camera import Camera
from daguerre.camera.parameters import CAMERA

DEFAULT_DEGREE: int = CAMERA["degree"].usual
DEFAULT_TOLERANCE: float = CAMERA["fit_tolerance"].usual


def judged(
    lens: _core.ExactLens, camera: Camera, name: str, pitch_mm: float, notes: list[str]
) -> tuple[_core.ExactLens, dict[str, Any]]:
    """Returns the lens to draw with: its fit, or its surfaces where the fit is not good enough.

    Args:
        lens: With a fit.
        camera: For the tolerance.
        name: Name of the lens, for notes.
        pitch_mm: Pixel pitch, mm.
        notes: Gets a sentence about the fit.

    Returns:
        The lens, and facts for metadata: degree, errors in um and px, and the model if it is not
        the one that was asked for.
    """
    fit = lens.fit
    assert fit is not None
    tolerance = DEFAULT_TOLERANCE if camera.fit_tolerance is None else camera.fit_tolerance
    um = pitch_mm * 1e3
    whole = fit.error.all.film
    facts: dict[str, Any] = {
        "fit_degree": fit.degree,
        "fit_error_um": whole.rms,
        "fit_error_px": whole.rms / um,
        "fit_largest_error_um": whole.max,
    }
    said = (
        f"the fit of {name} to degree {fit.degree} is off by {_length(whole.rms)} RMS on the film"
    )
    lit = [zone for zone in fit.error.zones if zone.rays]
    worst = max(lit, key=lambda zone: zone.film.rms)
    if worst.film.rms <= tolerance * um:
        notes.append(f"{said}, {whole.rms / um:.2g} px")
        return lens, facts
    exact = lens.without_fit()
    angles = [_field_deg(exact, worst.low, r) for r in (worst.low, worst.high)]
    notes.append(
        f"{said}, and {_length(worst.film.rms)} or {worst.film.rms / um:.2g} px at {worst.low:.3g} "
        f"to {worst.high:.3g} mm from the middle ({angles[0]:.0f} to {angles[1]:.0f} degrees off "
        f"the axis), beyond the {tolerance:g} px of fit_tolerance: the exact lens draws instead"
    )
    return exact, facts | {"lens_model": "exact"}


def _length(um: float) -> str:
    return f"{um:.2g} um" if um < 1000 else f"{um / 1000:.2g} mm"


def _field_deg(exact: _core.ExactLens, inner_mm: float, radius_mm: float) -> float:
    """From straight ahead to what a film point sees; if it sees nothing, the last before it."""
    angle = 0.0
    for step in range(9):
        x, y, z = exact.chief_direction(radius_mm - (radius_mm - inner_mm) * step / 8, 0.0)
        angle = math.degrees(math.atan2(math.hypot(x, y), -z))
        if angle > 0:
            break
    return angle
