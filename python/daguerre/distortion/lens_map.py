"""Distortion of lenses without axial symmetry: anamorphic, or with decentred elements."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from daguerre.analysis.bench import Bench
from daguerre.analysis.chief import ChiefRays, chief_rays
from daguerre.cached import cached_property
from daguerre.errors import InputError
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

from .model import Distortion, FloatArray

NODES = 51  # chief rays along each side
DEGREE = 24  # in x and y together
GUESS_DEGREE = 7
LEAST = 700  # chief rays that a fit needs
NEWTON = 12
MARGIN = 1.02  # extent of the fit, in sizes of the film
CHUNK = 1 << 14  # points at a time


@dataclass(frozen=True)
class LensMap(Distortion):
    """Distortion of any lens, for a plane at its focus distance, in two dimensions.

    Unlike ``LensDistortion``, this is a polynomial of both coordinates. It is fitted to the
    direction cosines of chief rays from a grid of film points; cosines stay smooth where tangents
    diverge. The ideal picture is a pinhole's with the lens's horizontal and vertical scale near the
    axis, so for an anamorphic lens it is equally squeezed.

    Attributes:
        bench: Lens on the bench.
        reach_mm: Largest distances from the axis that are needed, horizontal and vertical, mm.
        wavelength_nm: Wavelength, nm.
        focal_mm: Scales near the axis, horizontal and vertical, mm.
    """

    bench: Bench
    reach_mm: tuple[float, float]
    wavelength_nm: float = DESIGN_WAVELENGTH_NM
    focal_mm: tuple[float, float] = field(default=(0.0, 0.0))

    @classmethod
    def of_colours(
        cls, bench: Bench, reach_mm: tuple[float, float], wavelengths_nm: Sequence[float]
    ) -> list[LensMap]:
        """Returns models of one lens for several wavelengths, with common scales."""
        scales = _scales(bench)
        return [cls(bench, reach_mm, nm, scales) for nm in wavelengths_nm]

    def __post_init__(self) -> None:
        if self.focal_mm == (0.0, 0.0):
            object.__setattr__(self, "focal_mm", _scales(self.bench))

    @cached_property
    def _half(self) -> FloatArray:
        """Half extent of the film for which the fit holds, as distorted points."""
        return np.divide(self.reach_mm, self.focal_mm)

    @cached_property
    def _grid(self) -> tuple[FloatArray, FloatArray]:
        """Points of the fit in [-1, 1], denser toward the edges, and their cosines."""
        line = np.sin(0.5 * np.pi * np.linspace(-1, 1, NODES))
        at = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
        ideal = _ideal_points(self.bench, at * self._half * self.focal_mm, self.wavelength_nm)
        cosines, known = _cosines(ideal), np.isfinite(ideal).all(axis=1)
        if known.sum() < LEAST:
            raise InputError(
                f"{self.bench.lens.name}: distortion: wanted {LEAST} chief rays or more, got "
                f"{known.sum()}"
            )
        return at[known], cosines[known]

    @cached_property
    def _fit(self) -> FloatArray:
        """Coefficients of the cosines, shape (D, D, 2), first index x."""
        return _fitted(*self._grid, DEGREE)

    @cached_property
    def _inverse_fit(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Middle and half extent of the cosines, and coefficients of the inverse."""
        at, cosines = self._grid
        low, high = cosines.min(axis=0), cosines.max(axis=0)
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        return middle, half, _fitted((cosines - middle) / half, at, GUESS_DEGREE)

    @cached_property
    def _known(self) -> FloatArray:
        """Mask of film points with chief rays: 1 or 0 on a raster, rows of y."""
        line = np.linspace(-1, 1, NODES)
        at = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
        ideal = _ideal_points(self.bench, at * self._half * self.focal_mm, self.wavelength_nm)
        return np.asarray(np.isfinite(ideal).all(axis=1).reshape(NODES, NODES), np.float64)

    def _ideal(self, points: FloatArray) -> FloatArray:
        return _in_chunks(self._ideal_of, points)

    def _distorted(self, points: FloatArray) -> FloatArray:
        return _in_chunks(self._distorted_of, points)

    def _ideal_of(self, points: FloatArray) -> FloatArray:
        at = points / self._half
        known = self._inside(at)[:, None]
        return np.where(known, _tangents(_values(self._fit, np.where(known, at, 0))), np.nan)

    def _inside(self, at: FloatArray) -> NDArray[np.bool_]:
        """Whether points lie on the film with chief rays around them."""
        near = np.asarray((np.abs(at) <= MARGIN).all(axis=1))
        place = np.clip((np.where(near[:, None], at, 0) + 1) * 0.5 * (NODES - 1), 0, NODES - 1.001)
        low = place.astype(int)
        corners = [self._known[low[:, 1] + j, low[:, 0] + i] for j in (0, 1) for i in (0, 1)]
        return np.asarray(near & np.greater(np.min(corners, axis=0), 0), np.bool_)

    def _distorted_of(self, points: FloatArray) -> FloatArray:
        """Inverts by Newton's method, from a rough inverse."""
        middle, half, back = self._inverse_fit
        wanted = _cosines(points)
        near = np.asarray((np.abs((wanted - middle) / half) <= 1.2).all(axis=1))
        goal = np.where(near[:, None], wanted, middle)
        at = np.clip(_values(back, (goal - middle) / half), -MARGIN, MARGIN)
        for _ in range(NEWTON):
            miss = _values(self._fit, at) - goal
            if np.abs(miss).max(initial=0) < 1e-12:
                break
            step = _solved(self._slopes(at), miss)
            at = np.clip(at - step, -1.5 * MARGIN, 1.5 * MARGIN)
        # Beyond a fold there is a second solution, which the lens does not show.
        slopes = self._slopes(at)
        upright = slopes[:, 0, 0] * slopes[:, 1, 1] > slopes[:, 0, 1] * slopes[:, 1, 0]
        good = near & upright & self._inside(at) & (np.hypot(miss[:, 0], miss[:, 1]) < 1e-8)
        return np.where(good[:, None], at * self._half, np.nan)

    def _slopes(self, at: FloatArray) -> FloatArray:
        """Derivatives of the cosines by scaled points, shape (N, 2, 2); last axis: points."""
        parts = [_values(np.asarray(chebyshev.chebder(self._fit, axis=k)), at) for k in (0, 1)]
        return np.stack(parts, axis=2)


def _scales(bench: Bench) -> tuple[float, float]:
    """Image height over tangent near the axis, across and down, mm; equal unless anamorphic."""
    step = 1e-3 * abs(bench.order.efl)
    film = step * np.array([[-1.0, 0], [1, 0], [0, -1], [0, 1]])
    ideal = _ideal_points(bench, film, DESIGN_WAVELENGTH_NM)
    across, down = (2 * step / math.hypot(*(ideal[k + 1] - ideal[k])) for k in (0, 2))
    if not (math.isfinite(across) and math.isfinite(down)):
        raise InputError(
            f"{bench.lens.name}: distortion: wanted chief rays near the axis, got none"
        )
    if bench.lens.squeeze == 1:
        across = down = math.sqrt(across * down)
    return across, down


def _ideal_points(bench: Bench, film_mm: FloatArray, nm: float) -> FloatArray:
    """Ideal points (x right, y down) for points of the picture, mm; NaN: none."""
    # The picture is upside down on the film, and the film's y is up: both signs flip.
    film = film_mm * (-1, 1)
    found = [chief_rays(bench, film[k : k + CHUNK], nm) for k in range(0, len(film), CHUNK)]
    return np.concatenate([_seen(bench, rays) for rays in found])


def _seen(bench: Bench, rays: ChiefRays) -> FloatArray:
    d = rays.directions
    with np.errstate(invalid="ignore"):
        slopes = d[:, :2] / d[:, 2:]
        seen = -slopes
        if math.isfinite(bench.focus_mm):
            plane = bench.order.entrance_pupil.z - bench.focus_mm
            seen = (rays.points[:, :2] + slopes * (plane - rays.points[:, 2:])) / bench.focus_mm
        ahead = d[:, 2:] > 0.05
    return np.where(ahead, seen * (1, -1), np.nan)


def _cosines(points: FloatArray) -> FloatArray:
    """Direction cosines (x, y) of points at distance 1."""
    return np.asarray(points / np.sqrt(1 + (points**2).sum(axis=1, keepdims=True)))


def _tangents(cosines: FloatArray) -> FloatArray:
    """Points at distance 1 from direction cosines; NaN: 90 degrees or more."""
    rest = 1 - (cosines**2).sum(axis=1, keepdims=True)
    return np.asarray(cosines / np.sqrt(np.where(rest > 0, rest, np.nan)))


def _fitted(at: FloatArray, values: FloatArray, degree: int) -> FloatArray:
    """Coefficients (D, D, K), first index x, of total degree ``degree`` at most."""
    basis = chebyshev.chebvander2d(at[:, 0], at[:, 1], [degree, degree])
    i, j = np.indices((degree + 1, degree + 1)).reshape(2, -1)
    kept = i + j <= degree
    out = np.zeros(((degree + 1) ** 2, values.shape[1]))
    out[kept] = np.linalg.lstsq(basis[:, kept], values, rcond=1e-13)[0]
    return out.reshape(degree + 1, degree + 1, -1)


def _values(coefficients: FloatArray, at: FloatArray) -> FloatArray:
    """Values of a polynomial, shape (N, K), from coefficients (D, E, K)."""
    columns = chebyshev.chebvander(at[:, 0], coefficients.shape[0] - 1)
    rows = chebyshev.chebvander(at[:, 1], coefficients.shape[1] - 1)
    parts = [
        ((columns @ coefficients[:, :, k]) * rows).sum(axis=1) for k in range(coefficients.shape[2])
    ]
    return np.stack(parts, axis=1)


def _solved(matrices: FloatArray, values: FloatArray) -> FloatArray:
    """Solutions of 2 x 2 systems, shape (N, 2)."""
    (a, b), (c, d) = matrices.transpose(1, 2, 0)
    det = a * d - b * c
    det = np.where(np.abs(det) < 1e-30, np.inf, det)
    x, y = values.T
    return np.column_stack([(d * x - b * y) / det, (a * y - c * x) / det])


def _in_chunks(work: Callable[[FloatArray], FloatArray], points: FloatArray) -> FloatArray:
    parts = [work(points[k : k + CHUNK]) for k in range(0, len(points), CHUNK)]
    return np.concatenate(parts) if parts else points.copy()
