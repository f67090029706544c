"""Traces chief rays: from film points, backward through the centre of the stop."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from daguerre.argument_checks import guarded
from daguerre.checks import line
from daguerre.files.value import BriefRecord
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

from .bench import Bench, FloatArray

STEPS = 8  # from the axis to the film point; each step starts from the previous solution
NEWTON = 6  # most iterations of a step
ON_THE_WAY = 1e-3  # tolerance of all steps but the last, of the iris radius
EXACT = 1e-11  # tolerance of the last step, of the iris radius


@dataclass(frozen=True, repr=False)
class ChiefRays(BriefRecord):
    """Rays through the centre of the stop from each film point; NaN where no chief ray arrives.

    Attributes:
        film: Film points, mm, shape (N, 2).
        slopes: dx/dz, dy/dz at the film, shape (N, 2).
        points: Points on the first surface, shape (N, 3), mm.
        directions: Unit vectors in front of the lens, toward it, shape (N, 3).
    """

    film: FloatArray
    slopes: FloatArray
    points: FloatArray
    directions: FloatArray

    @property
    def angles(self) -> FloatArray:
        """Angles from the axis, in front of the lens, rad, shape (N,)."""
        d = self.directions
        return np.asarray(np.arctan2(np.hypot(d[:, 0], d[:, 1]), d[:, 2]))


@guarded
def chief_rays(
    bench: Bench, film_mm: ArrayLike, wavelength_nm: float = DESIGN_WAVELENGTH_NM
) -> ChiefRays:
    """Finds the chief rays of film points, by Newton's method on exact rays.

    Rays start at the film, where even a fisheye's field spans moderate angles. Clear apertures are
    ignored: a chief ray may be vignetted.

    Args:
        bench: The lens.
        film_mm: Film points, shape (N, 2), or image heights along y, shape (N,), mm.
        wavelength_nm: Wavelength, nm.
    """
    film = as_film_points(film_mm)
    slopes = np.zeros_like(film)
    reach = bench.film_z - bench.order.exit_pupil.z
    before = slopes
    for step in range(1, STEPS + 1):
        share = step / STEPS
        guess = film * share / reach if step < 2 else 2 * slopes - before
        before = slopes
        miss = ON_THE_WAY if step < STEPS else EXACT
        slopes = _aimed(bench, film * share, guess, wavelength_nm, miss)
    rays = bench.rays(*_from_film(bench, film, slopes), wavelength_nm, to_film=False, clip=False)
    directions = -rays.directions
    directions[~rays.passed] = np.nan
    return ChiefRays(film, slopes, rays.points, directions)


@guarded
def film_heights(bench: Bench, angles_deg: ArrayLike) -> FloatArray:
    """Image heights (mm) of chief rays at angles (deg) from the axis; NaN where there is none."""
    wanted = np.radians(line(angles_deg, "film_heights: angles_deg"))
    reach = 1.5 * bench.field_mm
    heights = np.linspace(0, reach, 97)
    angles = chief_rays(bench, heights).angles
    known = np.isfinite(angles)
    if known.any():  # keep heights up to where the angle stops growing
        rising = np.concatenate([[True], np.diff(angles[known]) > 0])
        last = int(np.argmin(rising)) if not rising.all() else len(rising)
        heights, angles = heights[known][:last], angles[known][:last]
    out = np.interp(wanted, angles, heights, right=np.nan)
    for _ in range(2):  # refine the interpolation by the secant method
        near = chief_rays(bench, out).angles
        far = chief_rays(bench, out * (1 + 1e-5) + 1e-7).angles
        with np.errstate(invalid="ignore", divide="ignore"):
            out = out - np.nan_to_num((near - wanted) * (out * 1e-5 + 1e-7) / (far - near))
    return np.asarray(out)


def as_film_points(film_mm: ArrayLike) -> FloatArray:
    """Converts image heights along y to film points (N, 2); points stay as they are."""
    film = np.atleast_1d(np.asarray(film_mm, np.float64))
    if film.ndim == 2:
        return film
    return np.column_stack([np.zeros_like(film), film])


def _aimed(
    bench: Bench, film: FloatArray, slopes: FloatArray, nm: float, miss: float
) -> FloatArray:
    """Slopes of rays through the centre of the stop, within a share of its radius, (N, 2)."""
    delta = 1e-5
    across, along = np.array([delta, 0.0]), np.array([0.0, delta])
    for _ in range(NEWTON):
        at = _iris(bench, film, slopes, nm)
        if np.nanmax(np.abs(at), initial=0) < miss * bench.iris_radius:
            break
        jx = (_iris(bench, film, slopes + across, nm) - at) / delta
        jy = (_iris(bench, film, slopes + along, nm) - at) / delta
        det = jx[:, 0] * jy[:, 1] - jy[:, 0] * jx[:, 1]
        with np.errstate(invalid="ignore", divide="ignore"):
            dx = (at[:, 0] * jy[:, 1] - at[:, 1] * jy[:, 0]) / det
            dy = (jx[:, 0] * at[:, 1] - jx[:, 1] * at[:, 0]) / det
        slopes = slopes - np.column_stack([dx, dy])
    return slopes


def _iris(bench: Bench, film: FloatArray, slopes: FloatArray, nm: float) -> FloatArray:
    rays = bench.rays(*_from_film(bench, film, slopes), nm, to_film=False, clip=False)
    return np.where(rays.passed[:, None], rays.iris, np.nan)


def _from_film(bench: Bench, film: FloatArray, slopes: FloatArray) -> tuple[FloatArray, FloatArray]:
    origins = np.column_stack([film, np.full(len(film), bench.film_z)])
    directions = -np.column_stack([slopes, np.ones(len(film))])
    bad = ~np.isfinite(directions).all(axis=1)
    directions[bad] = [math.tan(1.5), 0, -1]  # a ray that misses
    return origins, directions
