"""Sizes the open iris of a lens with neither an iris size nor an f-number in its file.

The iris is then as wide as the axial beam that the other clear diameters pass, to first order.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .checking import in_file, ray_to_pupil
from .errors import LensError
from .lens import DESIGN_WAVELENGTH_NM, Lens
from .surface import LensSurface, stop_of

#: Semi-diameter of a stop of unknown size while the paraxial beam is traced, mm.
PROBE = 1e-3


def probe(stop: LensSurface) -> LensSurface:
    """Returns a stop of unknown size as a small opening, for paraxial rays."""
    return stop.replaced(semi_diameter=PROBE, inner_semi_diameter=0.0)


def with_stop_of_other_diameters(lens: Lens, unsized: LensSurface) -> Lens:
    """Returns the lens with its iris sized by the other clear diameters, and a note.

    Without any clear diameter, a lens is a prescription: rays are traced through it unclipped.

    Args:
        lens: The lens with a ``probe`` as its stop.
        unsized: The stop as the file gives it.

    Raises:
        LensError: None of the surfaces with a clear diameter meets the axial beam.
    """
    stop = stop_of(lens.surfaces)
    heights = _heights(lens)
    known = [(i, clear) for i, s in enumerate(lens.surfaces) if (clear := _clear(s)) and i != stop]
    growth = {i: clear / heights[i] for i, clear in known if heights[i] > 0}
    surfaces = list(lens.surfaces)
    if not known:
        surfaces[stop] = unsized
        return lens.rebuilt(surfaces)
    if not growth or not heights[stop] > 0:
        raise no_stop_size(lens)
    limit = min(growth, key=lambda i: growth[i])
    size = float(growth[limit] * heights[stop])
    surfaces[stop] = unsized.replaced(semi_diameter=size, derived=True)
    note = (
        f"surface {stop}{in_file(lens, stop)}: the file gives no size of the stop: took "
        f"{2 * size:.4g} mm, the axial beam through surface {limit}{in_file(lens, limit)}"
    )
    return lens.rebuilt(surfaces, notes=(*lens.notes, note))


def check_stop_size(lens: Lens) -> None:
    """Raises an error if nothing gives the size of the stop."""
    if not np.isfinite(lens.first_order().stop_semi_diameter):
        raise no_stop_size(lens)


def no_stop_size(lens: Lens) -> LensError:
    """Returns the error of a lens with a stop of unknown size."""
    stop = stop_of(lens.surfaces)
    return LensError(
        f"{lens.source}: surface {stop}{in_file(lens, stop)}: wanted a clear diameter of the "
        "stop, an f-number, or clear diameters of other surfaces, got none",
        "lens-no-stop",
        stop,
    )


def _clear(surface: LensSurface) -> float | None:
    """Clear radius on both sides of a surface, mm; None: unknown."""
    known = [r for r in (surface.semi_diameter, surface.semi_diameter_after) if r is not None]
    return min(known, default=None)


def _heights(lens: Lens) -> NDArray[np.float64]:
    """Height at each surface of the axial ray through the rim of the iris, mm; 0: no ray."""
    pupil = lens.first_order().entrance_pupil
    out = np.zeros(len(lens.surfaces))
    for x, y in ((0.0, 1.0), (1.0, 0.0)):  # cylinders make two heights
        rim = 0.5 * pupil.diameter
        origin, direction = ray_to_pupil(lens, pupil.z, x * rim, y * rim)
        path = lens.prescription.path(origin[None], direction[None], DESIGN_WAVELENGTH_NM, False)
        if len(path) == len(out):
            out = np.maximum(out, np.hypot(path[:, 0], path[:, 1]))
    return out
