"""Figures over the field: curvature and astigmatism, distortion, colour, spherical aberration."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from daguerre.argument_checks import guarded
from daguerre.checks import line
from daguerre.files.value import BriefRecord
from daguerre.lenses import FirstOrder
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM
from daguerre.lenses.projections import projected

from .bench import FDC_NM, Bench, FloatArray
from .chief import chief_rays
from .pencils import FLAT_FIELD, Pencil, unbounded
from .plotted import Plotted


@dataclass(frozen=True, repr=False)
class FieldCurve(BriefRecord, Plotted):
    """Foci of the rays close to the chief ray, relative to the film.

    Attributes:
        height_mm: Image heights, mm, shape (N,).
        sagittal, tangential: Focus relative to the film, mm along the axis, positive away from
            the lens, shape (N,); NaN where no chief ray arrives.
    """

    height_mm: FloatArray
    sagittal: FloatArray
    tangential: FloatArray


@guarded
def field_curvature(
    bench: Bench, heights_mm: ArrayLike, wavelength_nm: float = DESIGN_WAVELENGTH_NM
) -> FieldCurve:
    """Computes sagittal and tangential foci over the field from rays close to the chief ray.

    The result agrees with Coddington's equations; differences of exact rays extend it to all kinds
    of surfaces.

    Args:
        bench: The lens; the object is a plane at its focus distance.
        heights_mm: Image heights along y, mm, shape (N,).
        wavelength_nm: Wavelength, nm.
    """
    heights = line(heights_mm, "field_curvature: heights_mm")
    out = np.full((len(heights), 2), np.nan)
    delta = 1e-3 * bench.pupil_diameter
    near = delta * np.array([[1, 0], [-1, 0], [0, 1], [0, -1]], np.float64)
    for i, height in enumerate(heights):
        light = narrow(bench, float(height))
        if light is None:
            continue
        rays = light.trace(near, wavelength_nm, clip=False)
        at = light.on_film(rays.at(bench.film_z))
        slope = light.on_film(light.film + rays.directions[:, :2] / rays.directions[:, 2:])
        for k in range(2):  # rays cross where their distance along that axis is 0
            apart, spread = (v[2 * k, k] - v[2 * k + 1, k] for v in (at, slope))
            out[i, k] = -apart / spread
    return FieldCurve(heights, out[:, 0], out[:, 1])


def narrow(bench: Bench, height: float) -> Pencil | None:
    """Pencil of an image height with its chief ray and axes, but not yet bounds of its light."""
    return unbounded(bench, np.array([0.0, height]), bench.focus_mm)


@dataclass(frozen=True, repr=False)
class Distortion(BriefRecord, Plotted):
    """Real image heights, and image heights of the lens's nominal projection.

    Attributes:
        height_mm: Real image heights, mm, shape (N,).
        angle_deg: Angle of the chief ray in front of the lens, degrees, shape (N,).
        ideal_mm: Image heights of the nominal projection, mm, shape (N,).
        law: Nominal projection: ``rectilinear``, or a fisheye's.
    """

    height_mm: FloatArray
    angle_deg: FloatArray
    ideal_mm: FloatArray
    law: str

    @property
    def percent(self) -> FloatArray:
        """(real - ideal) / ideal, %, shape (N,)."""
        with np.errstate(invalid="ignore", divide="ignore"):
            out = 100 * (self.height_mm - self.ideal_mm) / self.ideal_mm
        return np.where(self.height_mm == 0, 0.0, out)


@guarded
def distortion(bench: Bench, heights_mm: ArrayLike) -> Distortion:
    """Computes distortion from exact chief rays.

    A rectilinear lens is compared with the image of a plane object at the focus distance, a fisheye
    with its nominal projection; both are scaled to agree near the axis.

    Args:
        bench: The lens.
        heights_mm: Image heights along y, mm, shape (N,).
    """
    heights = line(heights_mm, "distortion: heights_mm")
    # The first sets the scale, which depends a little on the film's distance from paraxial focus.
    near = np.concatenate([[1e-3 * bench.field_mm], heights])
    angles = chief_rays(bench, near).angles
    if bench.is_fisheye or math.isinf(bench.focus_mm):
        ideal = projected(bench.projection, abs(bench.order.efl), angles)
    else:
        ideal = np.array([_object_height(bench, h) for h in near])
    ideal = ideal[1:] * (near[0] / ideal[0])
    return Distortion(heights, np.degrees(angles[1:]), ideal, bench.projection)


def _object_height(bench: Bench, height: float) -> float:
    light = narrow(bench, height)
    if light is None or light.source is None or light.angle > FLAT_FIELD:
        return math.nan
    return float(np.hypot(*light.source[:2]))


@guarded
def lateral_colour(
    bench: Bench, heights_mm: ArrayLike, wavelengths_nm: Sequence[float] = FDC_NM
) -> FloatArray:
    """Distances on the film from the chief ray of 587.56 nm to other chief rays, outward, mm.

    Args:
        bench: The lens.
        heights_mm: Image heights (of 587.56 nm) along y, mm, shape (N,).
        wavelengths_nm: Wavelengths, nm, shape (L,).

    Returns:
        Shape (N, L), mm; NaN where no chief ray arrives.
    """
    heights = np.atleast_1d(np.asarray(heights_mm, np.float64))
    out = np.full((len(heights), len(wavelengths_nm)), np.nan)
    for i, height in enumerate(heights):
        light = narrow(bench, float(height))
        if light is None:
            continue
        for j, nm in enumerate(wavelengths_nm):
            at = _through_the_middle(light, nm)
            rays = light.trace(at, nm, clip=False)
            out[i, j] = light.on_film(rays.at(bench.film_z))[0, 1]
    return out


def _through_the_middle(light: Pencil, nm: float) -> FloatArray:
    """Window coordinates (1, 2) of the ray through the centre of the stop, by Newton's method."""
    at, delta = np.zeros(2), 1e-4 * light.bench.pupil_diameter
    for _ in range(3):
        iris = light.trace(at + delta * np.array([[0, 0], [1, 0], [0, 1]]), nm, clip=False).iris
        jacobian = (iris[1:] - iris[0]).T / delta
        if not np.isfinite(jacobian).all() or abs(np.linalg.det(jacobian)) < 1e-12:
            return np.full((1, 2), np.nan)
        at = at - np.linalg.solve(jacobian, iris[0])
    return at[None, :]


@guarded
def axial_colour(bench: Bench, wavelengths_nm: ArrayLike) -> FloatArray:
    """Paraxial focus of each wavelength relative to the focus of 587.56 nm, mm, shape (L,).

    The object is at the focus distance; positive is away from the lens.
    """
    z = bench.order.entrance_pupil.z - bench.focus_mm
    orders = (
        bench.lens.first_order(float(nm))
        for nm in line(wavelengths_nm, "axial_colour: wavelengths_nm")
    )
    return np.array([_image_of(order, z) for order in orders]) - _image_of(bench.order, z)


def _image_of(order: FirstOrder, object_z: float) -> float:
    """Z of the paraxial image of a point on the axis, mm: x x' = f f'."""
    front = order.front_principal_point - order.front_focal_point
    return order.back_focal_point + order.efl * front / (order.front_focal_point - object_z)


@guarded
def spherical_aberration(
    bench: Bench, shares: ArrayLike, wavelength_nm: float = DESIGN_WAVELENGTH_NM
) -> FloatArray:
    """Points where rays of an axial object point cross the axis, from the film, mm, shape (N,).

    Args:
        bench: The lens.
        shares: Heights in the entrance pupil, 1 at its edge, shape (N,); 0 is the paraxial limit.
        wavelength_nm: Wavelength, nm.
    """
    light = narrow(bench, 0.0)
    if light is None:
        return np.full(np.shape(shares), np.nan)
    radius = 0.5 * bench.pupil_diameter
    height = np.maximum(np.asarray(shares, np.float64), 1e-3) * radius
    if light.source is not None:  # the window lies at the first vertex, the pupil behind it
        height = height * (light.center[2] - light.source[2]) / bench.focus_mm
    rays = light.trace(np.column_stack([np.zeros_like(height), height]), wavelength_nm, clip=False)
    y = rays.at(bench.film_z)[:, 1]
    return np.asarray(-y * rays.directions[:, 2] / rays.directions[:, 1])


__all__ = [
    "Distortion",
    "FieldCurve",
    "axial_colour",
    "distortion",
    "field_curvature",
    "lateral_colour",
    "spherical_aberration",
]
