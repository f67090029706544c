"""Describes the lens in the header of an exported file."""

from __future__ import annotations

import math
from typing import Any

from daguerre._core import __version__
from daguerre.files.json_item import clean


def facts(data: dict[str, Any]) -> list[str]:
    """Makes lines of text from ``LensFit.to_dict()``; names cannot contain line breaks."""
    name, setting, error = clean(data["lens"]), data["setting"], data["error"]["all"]
    angle, film, light = error["direction_rad"], error["film_um"], error["transmittance"]
    zoom = f" at {setting['zoom_mm']:.4g} mm" if setting["zoom_mm"] else ""
    focus = setting["focus_m"]
    distance = "infinity" if focus is None or math.isinf(focus) else f"{focus:.6g} m"
    half_x, half_y = data["film"]["half"]
    film_size = (
        f"film points within {half_x:.4g} mm of the axis"
        if data["symmetry"]["axial"]
        else f"film {2 * half_x:.4g} x {2 * half_y:.4g} mm"
    )
    return [
        f"{name}{zoom}: polynomials of degree {data['degree']}, fitted to exact rays.",
        f"Prescription: {clean(setting['source'] or '') or 'source not named'}.",
        f"f/{setting['f_stop']:.3g}, in focus at {distance} from the entrance pupil; {film_size}.",
        f"Error on {error['rays']} fresh rays, RMS and worst: direction {angle[0]:.2g} and "
        f"{angle[1]:.2g} rad;",
        f"on the film {film[0]:.2g} and {film[1]:.2g} um; transmittance {light[0]:.2g} and "
        f"{light[1]:.2g}.",
        f"Made by Daguerre {__version__}. Licence: Apache-2.0, like Daguerre.",
    ]
