"""Derives clear diameters that a source does not give from the rays of the full field.

The stop's size is known, from the table or from the f-number. From film points out to the corner,
rays are aimed at the rim of the stop and traced to the scene. Each surface becomes as wide as the
farthest of these rays, so that only apertures that the source gives can vignette a corner. No
surface becomes wider than where it meets its neighbour.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .lens import DESIGN_WAVELENGTH_NM, Lens
from .projections import projected
from .sag import sag
from .surface import LensSurface, bounding, stop_of
from .zoom import positions, with_stop

#: Number of fields between the axis and the corner, and of points on half the rim of the stop.
FIELDS, RIM = 6, 9
#: Derived clear diameters exceed the beam by this factor.
MARGIN = 1.01

Array = NDArray[np.float64]


def with_derived_diameters(lens: Lens) -> Lens:
    """Returns the lens with missing semi-diameters filled in and marked as derived.

    The lens is returned unchanged if all are known, if neither the stop's size nor an f-number is
    known, if no field is known, or if the lens has no axial symmetry.
    """
    missing = [i for i, s in enumerate(lens.surfaces) if s.semi_diameter is None]
    if not missing or not lens.prescription.is_axially_symmetric:
        return lens
    lens = _with_stop(lens)
    corner = image_radius(lens)
    if corner is None or any(s.stop and s.semi_diameter is None for s in lens.surfaces):
        return lens
    variants = [lens]
    if lens.zoom_mm is not None:
        variants = [with_stop(lens.with_gaps(p.gaps), p.stop) for p in positions(lens)]
    fields = np.linspace(0, corner, FIELDS)
    heights = np.max([_heights(at, y) for at in variants for y in fields], axis=0)
    surfaces = list(lens.surfaces)
    for i in missing:
        if not surfaces[i].stop and heights[i] > 0:
            size = min(MARGIN * float(heights[i]), _widest(surfaces[i].radius, surfaces[i].conic))
            surfaces[i] = surfaces[i].replaced(semi_diameter=size, derived=True)
    return lens.rebuilt(_trimmed(surfaces, variants))


def image_radius(lens: Lens) -> float | None:
    """Radius of the image circle, mm, as stated or from the stated field; None: none is stated."""
    nominal = lens.nominal
    if nominal.image_circle_mm:
        return nominal.image_circle_mm / 2
    if not nominal.full_field_deg:
        return None
    half, efl = math.radians(nominal.full_field_deg / 2), lens.first_order().efl
    law = nominal.projection or "rectilinear"
    if law == "rectilinear" and half > math.radians(70):
        law = "equidistant"
    return float(projected(law, efl, half))


def _with_stop(lens: Lens) -> Lens:
    """Sizes the open iris by the f-number if the table does not give its size."""
    surfaces = list(lens.surfaces)
    i = stop_of(surfaces)
    if surfaces[i].semi_diameter is not None or lens.nominal.f_number is None:
        return lens
    surfaces[i] = surfaces[i].replaced(semi_diameter=1.0)
    size = lens.rebuilt(surfaces).first_order().f_number / lens.nominal.f_number
    surfaces[i] = surfaces[i].replaced(semi_diameter=size, derived=True)
    return lens.rebuilt(surfaces)


def _widest(radius: float | None, conic: float) -> float:
    """Largest usable semi-diameter: a little less than where the surface becomes vertical."""
    return math.inf if radius is None or conic <= -1 else 0.998 * abs(radius) / math.sqrt(1 + conic)


def _trimmed(surfaces: list[LensSurface], variants: list[Lens]) -> list[LensSurface]:
    """Cuts derived semi-diameters where a surface would cross the next surface."""
    for i, j in itertools.pairwise(bounding(surfaces)):
        a, b = surfaces[i], surfaces[j]
        gap = min(float(at.vertices[j] - at.vertices[i]) for at in variants)
        r = np.linspace(0, min(a.semi_diameter or 0.0, b.semi_diameter or 0.0), 513)
        crossed = np.flatnonzero(gap + sag(b, r, 0 * r) - sag(a, r, 0 * r) < 0)
        if len(crossed):
            end = float(r[max(crossed[0] - 1, 1)])
            for k in (i, j):
                if surfaces[k].derived:
                    size = min(end, surfaces[k].semi_diameter or end)
                    surfaces[k] = surfaces[k].replaced(semi_diameter=size)
    return surfaces


def _heights(lens: Lens, y: float) -> Array:
    """Largest ray height at each surface for light from a film point, shape (surfaces,)."""
    film = np.array([0.0, y, lens.image_z])
    (stop,) = (s.semi_diameter or 0.0 for s in lens.surfaces if s.stop)
    angle = np.linspace(-np.pi / 2, np.pi / 2, RIM)
    rim = stop * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return beam_heights(lens, film, rim, _chief_guess(lens, film), (0.0, 0.5, 1.0))


def beam_heights(
    lens: Lens, film: Array, rim: Array, slope: Array, shares: Sequence[float]
) -> Array:
    """Largest height at each surface of rays from a film point through points of the stop.

    Args:
        lens: The lens.
        film: Film point, (3,), mm.
        rim: Points of the stop, shape (N, 2), mm.
        slope: Slope (dx/dz, dy/dz) at the film toward the middle of the stop, about.
        shares: Steps toward those points, of their distances from the axis; the last is 1.

    Returns:
        Shape (surfaces,), mm; rays that do not arrive are left out.
    """
    slopes = np.tile(slope, (len(rim), 1))
    out = np.zeros(len(lens.surfaces))
    for share in shares:
        slopes, points, directions = _aimed(lens, film, share * rim, slopes)
        for point, direction in zip(points, directions, strict=True):
            if np.isfinite(point).all():
                path = lens.prescription.path(
                    point[None] - direction, -direction[None], DESIGN_WAVELENGTH_NM, False
                )
                if len(path) == len(out):
                    out = np.maximum(out, np.hypot(path[:, 0], path[:, 1]))
    return out


def _chief_guess(lens: Lens, film: Array) -> Array:
    """Slope (dx/dz, dy/dz) toward the centre of the paraxial exit pupil."""
    z = lens.first_order().exit_pupil.z
    return np.array([0.0, -film[1] / (z - film[2]) if math.isfinite(z) else 0.0])


def _aimed(lens: Lens, film: Array, targets: Array, slopes: Array) -> tuple[Array, Array, Array]:
    """Aims exact rays at points of the stop by Newton's method.

    Returns:
        Slopes (N, 2), and the rays as they leave for the scene (N, 3); NaN where no ray arrives.
    """
    size = 1e-6 * (np.abs(targets).max() + 1e-3)
    points = directions = np.full((len(targets), 3), np.nan)
    for _ in range(20):
        iris, points, directions = _iris(lens, film, slopes)
        miss = iris - targets
        if np.nanmax(np.abs(miss), initial=0.0) < size:
            break
        steps = []
        for axis in np.eye(2) * 1e-5:
            steps.append((_iris(lens, film, slopes + axis)[0] - iris) / 1e-5)
        (a, c), (b, d) = steps[0].T, steps[1].T
        det = a * d - b * c
        move = np.stack([d * miss[:, 0] - b * miss[:, 1], a * miss[:, 1] - c * miss[:, 0]], 1)
        move = np.nan_to_num(move / det[:, None])
        reach = 0.2 * (1 + np.abs(slopes))  # no leaps into the unknown
        slopes = slopes - np.clip(move, -reach, reach)
    bad = ~(np.abs(iris - targets).max(axis=1) < 1e3 * size)
    points, directions = points.copy(), directions.copy()
    points[bad] = np.nan
    return slopes, points, directions


def _iris(lens: Lens, film: Array, slopes: Array) -> tuple[Array, Array, Array]:
    """Points where rays from the film cross the stop (N, 2), and the rays that leave; else NaN."""
    directions = -np.column_stack([slopes, np.ones(len(slopes))])
    origins = np.tile(film, (len(slopes), 1))
    nm = np.full(len(slopes), DESIGN_WAVELENGTH_NM)
    points, out, iris, _, _, stopped = lens.prescription.rays(
        origins, np.ascontiguousarray(directions), nm, False, False
    )
    out = np.asarray(out).copy()
    out[np.asarray(stopped) >= 0] = np.nan
    return np.asarray(iris), np.asarray(points), out
