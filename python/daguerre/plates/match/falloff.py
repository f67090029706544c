"""Measures vignetting in a photograph of an even surface, as the darkroom's polynomial."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.plates.photograph import Photograph

from .regions import overview

FloatArray = NDArray[np.float64]
Floats = NDArray[np.float32]
Terms = tuple[float, float, float]
#: Number of cells along the longer side of the picture; their means are fitted.
_CELLS = 48
#: Largest relative RMS residual of an even surface.
UNEVEN = 0.03
#: Largest gradient from the middle to a corner, relative to the light in the middle.
STEEP = 0.25


@dataclass(frozen=True)
class Falloff:
    """Light over the picture, 1 + k1 r^2 + k2 r^4 + k3 r^6, r = 1 in the corners.

    Attributes:
        terms: k1, k2 and k3 as measured.
        lens: Terms of the camera's lens as rendered; None: it has no falloff.
        rest: Relative RMS residual of the fit.
    """

    terms: Terms
    lens: Terms | None = None
    rest: float = 0.0

    @property
    def corner_ev(self) -> float:
        """Light in the corners relative to the middle, EV."""
        return float(np.log2(max(1 + sum(self.terms), 1e-6)))

    @property
    def lens_corner_ev(self) -> float | None:
        """Light in the corners relative to the middle for the lens as rendered, EV."""
        return None if self.lens is None else float(np.log2(max(1 + sum(self.lens), 1e-6)))

    def factor(self, rows: int, columns: int) -> Floats:
        """Factor from rendered light to the plate's, shape (rows, columns)."""
        r2 = radii_squared(rows, columns)
        measured = polynomial(self.terms, r2)
        return np.asarray(measured / polynomial(self.lens or (0, 0, 0), r2), np.float32)


def radii_squared(rows: int, columns: int) -> FloatArray:
    """Square of the distance from the middle, 1 in the corners of the picture."""
    y = np.arange(rows) + 0.5 - rows / 2
    x = np.arange(columns) + 0.5 - columns / 2
    return np.asarray((y[:, None] ** 2 + x**2) / (rows**2 / 4 + columns**2 / 4))


def polynomial(terms: Terms, r2: FloatArray) -> FloatArray:
    """Light at squared radii; never below 1/1000."""
    k1, k2, k3 = terms
    return np.asarray(np.maximum(1 + r2 * (k1 + r2 * (k2 + r2 * k3)), 1e-3))


class FalloffFit(NamedTuple):
    """Fit of the polynomial.

    Attributes:
        terms: The polynomial.
        residual: Relative RMS residual.
        more: Coefficients of other functions, shape (M,).
    """

    terms: Terms
    residual: float
    more: FloatArray


def fitted(light: FloatArray, r2: FloatArray, more: FloatArray | None = None) -> FalloffFit:
    """Fits the polynomial.

    Args:
        light: Any scale, shape (N,).
        r2: Squared radii, shape (N,).
        more: Other functions to fit and leave out of the polynomial, shape (N, M).
    """
    columns = np.stack([np.ones_like(r2), r2, r2**2, r2**3], axis=1)
    if more is not None:
        columns = np.concatenate([columns, more], axis=1)
    found = np.linalg.lstsq(columns, light, rcond=None)[0]
    rest = float(np.sqrt(np.mean((light - columns @ found) ** 2)) / found[0])
    k1, k2, k3 = (float(found[k] / found[0]) for k in (1, 2, 3))
    return FalloffFit((k1, k2, k3), rest, np.asarray(found[4:] / found[0]))


def falloff_of(flat: Photograph) -> Falloff:
    """Measures the falloff in a photograph of an even surface.

    A linear gradient, as of a surface lit from one side, is fitted and removed.

    Raises:
        InputError: The photograph is clipped, dark, or not even.
    """
    light, y, x = _means(flat)
    if not (light > 0).all():
        raise InputError(f"{flat.path}: flat: wanted light everywhere, got dark parts")
    terms, rest, slopes = fitted(light, y**2 + x**2, np.stack([y, x], axis=1))
    if np.hypot(*slopes) > STEEP:
        raise InputError(
            f"{flat.path}: flat: wanted an even surface, got a gradient of "
            f"{2 * np.hypot(*slopes):.0%} from one corner to the other"
        )
    if rest > UNEVEN:
        raise InputError(
            f"{flat.path}: flat: wanted an even surface, got light that deviates by {rest:.1%} "
            "from a smooth falloff"
        )
    return Falloff(terms, None, rest)


def _means(flat: Photograph) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Means of light over cells, and y and x of their centres; the corners are at distance 1."""
    plane, _ = overview(flat)
    clipped = _top(flat)
    if (plane >= clipped).mean() > 1e-3:
        raise InputError(f"{flat.path}: flat: some pixels are clipped; take it with less exposure")
    side = max(max(plane.shape) // _CELLS, 1)
    rows, columns = (length // side for length in plane.shape)
    cut = plane[: rows * side, : columns * side] - np.float32(_black(flat))
    light = _decoded(flat, cut).reshape(rows, side, columns, side)
    reach = 0.5 * float(np.hypot(*plane.shape))
    y = ((np.arange(rows) + 0.5) * side - plane.shape[0] / 2) / reach
    x = ((np.arange(columns) + 0.5) * side - plane.shape[1] / 2) / reach
    places = np.meshgrid(y, x, indexing="ij")
    means = light.mean(axis=(1, 3), dtype=np.float64)
    return means.ravel(), places[0].ravel(), places[1].ravel()


def _top(flat: Photograph) -> float:
    if flat.raw is not None:
        return 0.98 * flat.raw.white
    assert flat.pixels is not None
    return float(np.iinfo(flat.pixels.dtype).max) if flat.kind == "display" else np.inf


def _black(flat: Photograph) -> float:
    return 0.0 if flat.raw is None else float(flat.raw.black[flat.raw.cells].mean())


def _decoded(flat: Photograph, plane: Floats) -> Floats:
    if flat.kind != "display":
        return plane
    from daguerre.color import srgb

    assert flat.pixels is not None
    return np.asarray(srgb.to_linear(plane / np.float32(np.iinfo(flat.pixels.dtype).max)))
