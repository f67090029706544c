"""The wave that converges on an image point, as a function of direction.

Behind the lens the light of one object point is a fan of plane waves, one along each ray. W(a, b)
is the optical path of the wave with direction cosines a, b: from the object along the ray, to the
foot of the perpendicular from the image point. The amplitude at a film point d away is the Fourier
sum of exp(i k (W + a dx + b dy)), for every aperture and field, without a reference sphere. Source:
Debye 1909, as in Born and Wolf, Principles of Optics, 7th ed., section 8.8; W is the angle
characteristic's form of the aberration function (section 5.1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import rows, whole
from daguerre.files.value import BriefRecord
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

from .bench import BoolArray, FloatArray, Rays
from .pencils import Pencil
from .plotted import Plotted

ComplexArray = NDArray[np.complex128]

DEGREE = 5  # degree in each axis of the map from directions to the window
PROBES = 25  # rays across to fit the map


@guarded
@dataclass(frozen=True, repr=False)
class Wavefront(BriefRecord, Plotted):
    """The pupil of one image point on a regular grid of directions.

    Attributes:
        step: Step of the direction cosines between neighbours.
        cosines: Direction cosines along the sagittal and tangential axes, shape (n, n, 2).
        path: W in mm, with mean 0 over the light, shape (n, n).
        amplitude: Square root of the light, 0 where none passes, shape (n, n).
        wavelength_nm: Wavelength, nm.
    """

    step: float
    cosines: FloatArray
    path: FloatArray
    amplitude: FloatArray
    wavelength_nm: float

    @property
    def lit(self) -> BoolArray:
        """Whether light passes, shape (n, n)."""
        return np.asarray(self.amplitude > 0)

    @property
    def waves(self) -> FloatArray:
        """W in wavelengths; NaN in the dark, shape (n, n)."""
        return np.where(self.lit, self.path / (1e-6 * self.wavelength_nm), np.nan)

    @property
    def rms_waves(self) -> float:
        """RMS of W over the light, less its best-fit plane, in wavelengths."""
        w, a = self.waves[self.lit], self.cosines[self.lit]
        basis = np.column_stack([np.ones(len(w)), a])
        return float(np.std(w - basis @ np.linalg.lstsq(basis, w, rcond=None)[0]))

    @property
    def pupil_function(self) -> ComplexArray:
        """Complex amplitude, shape (n, n)."""
        k = 2e6 * np.pi / self.wavelength_nm
        return np.asarray(self.amplitude * np.exp(1j * k * self.path))

    def defocused(self, dz: float) -> Wavefront:
        """Returns the wavefront about a point ``dz`` (mm) further from the lens along the axis."""
        cos_z = np.sqrt(np.maximum(0.0, 1 - (self.cosines**2).sum(axis=-1)))
        path = self.path + dz * cos_z
        return Wavefront(self.step, self.cosines, path, self.amplitude, self.wavelength_nm)


@guarded
def wavefront(
    light: Pencil,
    wavelength_nm: float = DESIGN_WAVELENGTH_NM,
    *,
    grid: int = 64,
    about: FloatArray | None = None,
) -> Wavefront | None:
    """Computes the wavefront of one object point, from the optical paths of exact rays.

    Args:
        light: From ``pencil``.
        wavelength_nm: Wavelength, nm.
        grid: Directions across.
        about: Image point, sagittal and tangential, mm from the chief ray's; None: the chief ray's.

    Returns:
        The wavefront, or None if no light arrives.
    """
    whole(grid, "wavefront: grid", 2, 4096)
    about = None if about is None else rows(about, "wavefront: about", 2)[0]
    window, cosines, step = _directions(light, wavelength_nm, grid)
    if window is None:
        return None
    at = window.reshape(-1, 2)
    rays = light.trace(at, wavelength_nm)
    off = light.on_film(rays.at(light.bench.film_z)) - (0 if about is None else about)
    # dW/da = -(the ray's film point): extends W from the ray's direction to the grid's.
    path = _path_to(light, rays, about)
    path = path - (off * (cosines.reshape(-1, 2) - _cosines(light, rays))).sum(axis=1)
    share = np.where(rays.passed, light.flux(at) * rays.transmittance, 0.0)
    if not share.any():
        return None
    mean = float((share * np.nan_to_num(path)).sum() / share.sum())
    shape = cosines.shape[:2]
    return Wavefront(
        step,
        cosines,
        np.where(share > 0, path - mean, 0.0).reshape(shape),
        np.sqrt(share).reshape(shape),
        wavelength_nm,
    )


def _path_to(light: Pencil, rays: Rays, about: FloatArray | None) -> FloatArray:
    """Optical path to the foot of the perpendicular from the image point, mm, shape (N,)."""
    r, x = light.radial, np.zeros(2) if about is None else about
    film = light.film + x[0] * np.array([r[1], -r[0]]) + x[1] * r
    point = np.array([*film, light.bench.film_z])
    return np.asarray(rays.path + ((point - rays.points) * rays.directions).sum(axis=1))


def _cosines(light: Pencil, rays: Rays) -> FloatArray:
    """Direction cosines behind the lens along the sagittal and tangential axes, (N, 2)."""
    out = light.on_film(light.film + rays.directions[:, :2])
    return np.where(rays.passed[:, None], out, np.nan)


def _directions(
    light: Pencil, nm: float, count: int
) -> tuple[FloatArray | None, FloatArray, float]:
    """Window coordinates of rays that leave on a regular grid of directions, the grid, its step.

    The map is a polynomial fitted to a few rays. Its error is corrected to second order by the
    directions of the traced rays.
    """
    at = light.grid(PROBES)
    rays = light.trace(at, nm, clip=False)
    lit = light.trace(at, nm).passed
    cosines = _cosines(light, rays)
    if not lit.any():
        return None, cosines, 0.0
    low, high = cosines[lit].min(axis=0), cosines[lit].max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * float((high - low).max())
    half *= 1 + 2.5 / PROBES
    step = 2 * half / count
    u = (np.arange(count) - (count - 1) / 2) * step
    wanted = np.stack(np.meshgrid(middle[0] + u, middle[1] + u), -1)
    scaled = (cosines - middle) / half
    near = np.isfinite(scaled).all(axis=1) & (np.abs(scaled) < 1.3).all(axis=1)
    basis = chebyshev.chebvander2d(scaled[near, 0], scaled[near, 1], [DEGREE, DEGREE])
    fit = np.linalg.solve(
        basis.T @ basis + 1e-12 * np.eye(basis.shape[1]), basis.T @ at[near]
    ).reshape(DEGREE + 1, DEGREE + 1, 2)
    ladder = chebyshev.chebvander(u / half, DEGREE)  # the grid is a product of axes
    window = np.einsum("xi,ijk,yj->yxk", ladder, fit, ladder, optimize=True)
    return window, wanted, step
