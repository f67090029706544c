"""The pupil of a real lens seen from the film: an iris, clipped by mounts, with aberrations.

A ray with direction cosines a toward the film point crosses the iris at a point that is a smooth
function of a. That function is fitted, so blades keep sharp and straight edges on any raster.
Clipping by mounts is traced on a raster and smoothed. The wavefront comes from ``wavefronts``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.errors import InputError
from daguerre.files.value import BriefRecord

from .bench import Bench, FloatArray
from .diffraction import Pupil
from .iris import Floats, Iris
from .pencils import Pencil, pencil
from .wavefronts import Wavefront, wavefront

RAYS = 72  # rays across the window, for the fits
MOUNTS = 192  # directions across the raster of the mounts
IRIS_DEGREE = 7
PATH_DEGREE = 12
DESIGN_NM = 550.0


@dataclass(frozen=True, repr=False)
class LensPupil(BriefRecord):
    """The part of the iris seen from a film point, and the wave that comes from it.

    Attributes:
        low, high: Bounds of the light in direction cosines along x and y of the picture.
        iris: Shape of the iris, in units of its radius.
        to_iris: Coefficients of Chebyshev polynomials that map the cosines, scaled to [-1, 1], to
            points on the iris, shape (D, D, 2), rows of y.
        mounts: Share of light that mounts let pass, on a raster of the cosines, rows of y
            (upward), shape (M, M).
        paths: Coefficients (D, D) of W in mm by wavelength (nm), in the basis of ``to_iris``;
            empty: a perfect wave.
    """

    low: tuple[float, float]
    high: tuple[float, float]
    iris: Iris
    to_iris: FloatArray
    mounts: Floats
    paths: dict[float, FloatArray] = field(default_factory=dict)

    @property
    def perfect(self) -> bool:
        """Whether there are no aberrations: ``paths`` is empty."""
        return not self.paths

    def amplitude(self, x: Floats, y: Floats, wavelength_nm: float) -> NDArray[Any]:
        """Amplitudes (B, A) on a raster of cosines x (A,) and y (B,); complex if not perfect."""
        u, v = (_scaled(a, *ends) for a, *ends in zip((x, y), self.low, self.high, strict=True))
        places = [_evaluated(self.to_iris[:, :, k], u, v) for k in range(2)]
        pitch = float(np.hypot(*(np.ptp(p[len(p) // 2, [0, -1]]) for p in places)) / (len(x) - 1))
        waves = self.iris.amplitude(places[0], places[1], pitch)
        inside = (np.abs(u) <= 1.001) & (np.abs(v) <= 1.001)[:, None]
        waves *= inside * self._mounted(u, v)
        if not self.paths:
            return waves
        nearest = min(self.paths, key=lambda nm: abs(nm - wavelength_nm))
        turns = _evaluated(self.paths[nearest], u, v, np.float64) / (1e-6 * wavelength_nm)
        phase = (2 * np.pi * (turns - np.round(turns))).astype(np.float32)
        return np.asarray(waves * np.exp(1j * phase), np.complex64)

    def _mounted(self, u: FloatArray, v: FloatArray) -> Floats:
        """Share of light that mounts let pass (B, A); its edges are as sharp as their raster."""
        if self.mounts.all():
            return np.ones((len(v), len(u)), np.float32)
        n = len(self.mounts)
        at = [np.clip((s + 1) * 0.5 * n - 0.5, 0, n - 1.001) for s in (u, v)]
        (i, s), (j, t) = ((np.floor(p).astype(int), (p % 1).astype(np.float32)) for p in at)
        across = self.mounts[:, i] * (1 - s) + self.mounts[:, i + 1] * s
        open_share = across[j] * (1 - t)[:, None] + across[j + 1] * t[:, None]
        return np.asarray(np.clip(4 * open_share - 1.5, 0, 1), np.float32)


@guarded
def lens_pupil(
    bench: Bench,
    film_mm: tuple[float, float],
    iris: Iris | None = None,
    wavelengths_nm: Sequence[float] = (),
) -> LensPupil | None:
    """Computes the pupil seen from a film point.

    Args:
        bench: The lens.
        film_mm: Film point (x, y) in the lens frame, mm.
        iris: Shape of the iris; None: round.
        wavelengths_nm: Wavelengths of the wavefronts, nm; empty: a perfect wave.

    Returns:
        The pupil, or None if no light arrives there.
    """
    iris = iris or Iris()
    wide = replace(bench, iris_radius=bench.iris_radius * iris.outer_radius)
    light = pencil(wide, film_mm)
    if light is None:
        return None
    at = light.grid(RAYS)
    free = light.trace(at, DESIGN_NM, clip=False)
    lit = light.trace(at, DESIGN_NM).passed
    cosines = -free.directions[:, :2]  # of the picture, which is upside down on the film
    if np.count_nonzero(lit) < 16:
        return None
    margin = 1.5 * np.ptp(cosines[lit], axis=0) / RAYS
    low, high = cosines[lit].min(axis=0) - margin, cosines[lit].max(axis=0) + margin
    scaled = _scaled(cosines, low, high)
    near = np.isfinite(scaled).all(axis=1) & (np.abs(scaled) < 1.2).all(axis=1)
    near &= np.isfinite(free.iris).all(axis=1) & _about(at, lit)
    ends = (float(low[0]), float(low[1])), (float(high[0]), float(high[1]))
    return LensPupil(
        *ends,
        iris,
        _fitted(scaled[near], free.iris[near] / bench.iris_radius, IRIS_DEGREE),
        _mounts(light, _fitted(scaled[near], at[near], IRIS_DEGREE)),
        {nm: path for nm in wavelengths_nm if (path := _path(light, nm, low, high)) is not None},
    )


def _about(at: FloatArray, lit: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Selects rays near the light: others, far out, may leave in the same directions."""
    low, high = at[lit].min(axis=0), at[lit].max(axis=0)
    reach = 0.6 * (high - low)
    return np.asarray((np.abs(at - 0.5 * (low + high)) <= reach).all(axis=1))


def zone_pupils(
    bench: Bench,
    frame_mm: tuple[float, float],
    zones: int,
    iris: Iris | None = None,
    wavelengths_nm: Sequence[float] = (),
    center_mm: tuple[float, float] = (0.0, 0.0),
) -> list[list[Pupil]]:
    """Computes the pupils of a regular grid of points, from upper left to lower right corner.

    Args:
        bench: The lens.
        frame_mm: Width and height of the frame, mm.
        zones: Points along each side; 1: only the centre.
        iris: Shape of the iris; None: round.
        wavelengths_nm: Wavelengths of the wavefronts, nm; see ``lens_pupil``.
        center_mm: Film point of the frame's centre, mm.

    Returns:
        Rows of pupils. A point without light has the centre's pupil, or the first lit pupil.
    """
    share = np.linspace(-0.5, 0.5, zones) if zones > 1 else np.zeros(1)
    found = [
        [
            lens_pupil(
                bench,
                # The picture is upside down on the film: its left is at positive x.
                (center_mm[0] - float(x) * frame_mm[0], center_mm[1] + float(y) * frame_mm[1]),
                iris,
                wavelengths_nm,
            )
            for x in share
        ]
        for y in share
    ]
    lit = [p for row in found for p in row if p is not None]
    if not lit:  # only corners, all outside the image circle
        lit = [p for p in [lens_pupil(bench, center_mm, iris, wavelengths_nm)] if p is not None]
    if not lit:
        raise InputError(f"{bench.lens.name}: no light reaches the film")
    spare = found[zones // 2][zones // 2] or lit[0]
    return [[p or spare for p in row] for row in found]


def _mounts(light: Pencil, to_window: FloatArray) -> Floats:
    """Share of light that mounts let pass on a raster of scaled cosines, with smoothed edges."""
    free = replace(light, bench=replace(light.bench, iris_radius=np.inf))
    u = (np.arange(MOUNTS) + 0.5) / MOUNTS * 2 - 1
    window = np.stack([_evaluated(to_window[:, :, k], u, u, np.float64) for k in range(2)], -1)
    passed = free.trace(window.reshape(-1, 2), DESIGN_NM).passed
    soft = passed.reshape(MOUNTS, MOUNTS).astype(np.float32)
    if soft.all():
        return soft
    for axis in (0, 1, 0, 1):
        around = [np.roll(soft, k, axis) for k in (-1, 1)]
        soft = 0.5 * soft + 0.25 * (around[0] + around[1])
    return soft


def _path(light: Pencil, nm: float, low: FloatArray, high: FloatArray) -> FloatArray | None:
    """Coefficients of W in the picture's cosines; None: no light arrives."""
    wave: Wavefront | None = wavefront(light, nm, grid=96)
    if wave is None:
        return None
    r = light.radial
    axes = np.array([[r[1], -r[0]], [r[0], r[1]]])  # sagittal, tangential
    cosines = -(wave.cosines[wave.lit] @ axes)
    return _fitted(_scaled(cosines, low, high), wave.path[wave.lit], PATH_DEGREE)


def _scaled(v: NDArray[Any], low: float | FloatArray, high: float | FloatArray) -> FloatArray:
    """Maps [low, high] to [-1, 1]."""
    return np.asarray((np.asarray(v, np.float64) - low) * 2 / (np.subtract(high, low)) - 1)


def _fitted(at: FloatArray, values: FloatArray, degree: int) -> FloatArray:
    """Fits coefficients (D, D, ...), rows of y, of total degree ``degree`` or less."""
    basis = chebyshev.chebvander2d(at[:, 1], at[:, 0], [degree, degree])
    i, j = np.indices((degree + 1, degree + 1)).reshape(2, -1)
    kept = i + j <= degree
    out = np.zeros(((degree + 1) ** 2, *values.shape[1:]))
    out[kept] = np.linalg.lstsq(basis[:, kept], values, rcond=1e-12)[0]
    return out.reshape(degree + 1, degree + 1, *values.shape[1:])


def _evaluated(
    coefficients: FloatArray, u: FloatArray, v: FloatArray, dtype: type = np.float32
) -> NDArray[Any]:
    """Evaluates a polynomial on the raster of u (columns) and v (rows)."""
    degree = len(coefficients) - 1
    rows, columns = chebyshev.chebvander(v, degree), chebyshev.chebvander(u, degree)
    return np.asarray((rows @ coefficients @ columns.T), dtype)
