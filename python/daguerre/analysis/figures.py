"""All figures of one lens at one setting, for the data sheet and ``--json``."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.files.value import BriefRecord

from .bench import FDC_NM, Bench, FloatArray
from .field import (
    Distortion,
    FieldCurve,
    axial_colour,
    distortion,
    field_curvature,
    lateral_colour,
    spherical_aberration,
)
from .illumination import Illumination, pupil_outline, relative_illumination, within_light
from .mtf import diffraction_mtf, geometric_mtf
from .pencils import Pencil, pencil
from .plotted import Plotted
from .psf import Psf, point_spread, strehl_ratio
from .seidel import SeidelSums, seidel_sums
from .spots import Spot, spot
from .wavefronts import Wavefront, wavefront

#: Shares of the field at which spots, PSFs and pupils are shown.
FIELDS = (0.0, 0.35, 0.6, 0.8, 1.0)
#: Rays across: enough for drawings of a few millimetres, and computed in seconds.
PSF_GRID, ILLUMINATION_GRID = 160, 56
#: Spatial frequencies of the MTF over the field, cycles per mm.
FREQUENCIES = (10.0, 20.0, 40.0)
CURVE = np.linspace(0, 1, 21)
#: Shares of the field at which the MTF is computed; they include FIELDS.
MTF_FIELDS = (0.0, 0.15, 0.35, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
PUPIL_SHARES = np.linspace(0, 1, 33)
COLORS_NM = np.linspace(400, 700, 31)


@dataclass(frozen=True, repr=False)
class FieldPoint(BriefRecord):
    """Spot, PSF and outline of the pupil at one image height."""

    height_mm: float
    angle_deg: float
    spot: Spot | None
    psf: Psf | None
    outline: FloatArray


@dataclass(frozen=True, repr=False)
class Figures(BriefRecord, Plotted):
    """Figures at one focal length, focus and f-stop.

    The field ends where 2 % of the axis's light is left, if that is within the image circle.

    Attributes:
        points: Spots, PSFs and pupils at FIELDS.
        frequency: Spatial frequencies, cycles per mm, shape (Q,).
        mtf_waves, mtf_rays: MTF of waves and of rays at MTF_FIELDS, shape (H, Q, 2): sagittal,
            tangential.
        curves: Field curvature at F, d and C.
        lateral: Lateral colour of F, d and C, shape (21, 3), mm.
        axial: Axial colour at COLORS_NM, mm.
        spherical: Spherical aberration of F, d and C at PUPIL_SHARES, shape (3, 33), mm.
        on_axis: Wavefront of 587.56 nm on the axis.
    """

    bench: Bench
    points: tuple[FieldPoint, ...]
    frequency: FloatArray
    mtf_waves: FloatArray
    mtf_rays: FloatArray
    curves: tuple[FieldCurve, ...]
    distortion: Distortion
    lateral: FloatArray
    axial: FloatArray
    spherical: FloatArray
    illumination: Illumination
    seidel: SeidelSums | None
    on_axis: Wavefront | None

    def mtf_over_field(self, per_mm: float) -> FloatArray:
        """MTF of waves at MTF_FIELDS and one frequency, shape (H, 2)."""
        return np.asarray(self.mtf_waves[:, int(np.argmin(np.abs(self.frequency - per_mm)))])

    @property
    def strehl(self) -> float:
        """Strehl ratio on the axis at 587.56 nm."""
        return strehl_ratio(self.on_axis) if self.on_axis is not None else float("nan")


@guarded
def data_sheet(bench: Bench, *, psf_pixels: int = 64) -> Figures:
    """Computes every figure.

    Args:
        bench: The lens at its setting.
        psf_pixels: Width of the PSFs, px.
    """
    bench = within_light(bench)
    field = bench.field_mm
    lights = {share: pencil(bench, share * field) for share in MTF_FIELDS}
    frequency = np.linspace(0, 2 * FREQUENCIES[-1], 33)
    along = field * CURVE
    on_axis = lights[0.0]
    return Figures(
        bench=bench,
        points=tuple(
            _field_point(bench, share * field, lights[share], psf_pixels) for share in FIELDS
        ),
        frequency=frequency,
        mtf_waves=np.array([_mtf(light, frequency) for light in lights.values()]),
        mtf_rays=np.array([_mtf_rays(light, frequency) for light in lights.values()]),
        curves=tuple(field_curvature(bench, along, nm) for nm in FDC_NM),
        distortion=distortion(bench, along),
        lateral=lateral_colour(bench, along),
        axial=axial_colour(bench, COLORS_NM),
        spherical=np.array([spherical_aberration(bench, PUPIL_SHARES, nm) for nm in FDC_NM]),
        illumination=relative_illumination(bench, along, grid=ILLUMINATION_GRID),
        seidel=seidel_sums(bench),
        on_axis=wavefront(on_axis, grid=96) if on_axis else None,
    )


def _field_point(bench: Bench, height: float, light: Pencil | None, pixels: int) -> FieldPoint:
    outline = pupil_outline(bench, height)
    if light is None:
        return FieldPoint(height, float("nan"), None, None, outline)
    rays = spot(light)
    if not len(rays.weights):
        return FieldPoint(height, float(np.degrees(light.angle)), None, None, outline)
    psf = point_spread(light, pixels=pixels, max_grid=PSF_GRID)
    return FieldPoint(height, float(np.degrees(light.angle)), rays, psf, outline)


def _mtf(light: Pencil | None, frequency: FloatArray) -> FloatArray:
    return np.zeros((len(frequency), 2)) if light is None else diffraction_mtf(light, frequency)


def _mtf_rays(light: Pencil | None, frequency: FloatArray) -> FloatArray:
    if light is None:
        return np.zeros((len(frequency), 2))
    return geometric_mtf(spot(light, grid=64, jitter=True), frequency)
