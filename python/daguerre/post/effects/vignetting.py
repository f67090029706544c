"""Vignetting: light that falls off toward the edge of the picture, and its removal."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.convolution.rows import Rows
from daguerre.errors import UsageError
from daguerre.post.array import on_array
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.lens_light import Falloff, lens_light
from daguerre.post.optics import (
    FOCAL_LENGTH,
    LENS,
    SENSOR,
    bench,
    film_plane,
    focal_length_mm,
    offsets,
)
from daguerre.post.parameter import Parameter
from daguerre.post.picture import Band, Canvas, Image

DARK = 1e-4  # smallest relative illumination that can be undone


def reciprocal(share: NDArray[np.float32]) -> tuple[NDArray[np.float32], int]:
    """Returns 1 / share, 0 where that is too dark to undo, and the number of such pixels.

    ``share`` has shape (rows, W) or (rows, W, C); a pixel counts if any channel is too dark.
    """
    lost = np.asarray(share < DARK)
    if share.ndim == 3:
        lost = np.asarray(lost.any(axis=2, keepdims=True))
    over = np.where(lost, 0, 1 / np.where(lost, 1, share)).astype(np.float32)
    return over, int(lost.sum())


class _Vignetting(Step):
    """Multiplies colours by the relative illumination; alpha is not changed."""

    def __init__(self, canvas: Canvas, falloff: Falloff, *, inverse: bool) -> None:
        self._colors = len(canvas.colors) - canvas.alpha
        self._falloff, self._inverse = falloff, inverse
        self._dark = 0

    def apply(self, band: Band, rows: Rows) -> Band:
        factor = self._falloff(rows)
        if factor.ndim == 2:
            factor = factor[:, :, None]
        if self._inverse:
            factor, dark = reciprocal(factor)
            self._dark += dark
        image = band.image.copy()
        image[:, :, : self._colors] *= factor
        return band.with_image(image)

    def remarks(self) -> list[str]:
        found = [f"{self._dark} pixels that get no light are set to 0"]
        return found if self._dark else []


def _natural(canvas: Canvas, values: Values) -> Falloff:
    """Natural falloff: cos^4 of the angle from the axis (Kolb, Mitchell and Hanrahan 1995)."""
    film, focal_length = film_plane(canvas, values), focal_length_mm(canvas, values)

    def falloff(rows: Rows) -> NDArray[np.float32]:
        tangent = film.radii(canvas, rows) / np.float32(focal_length)
        return np.asarray(1 / (1 + tangent * tangent) ** 2, np.float32)

    return falloff


def radial_polynomial(canvas: Canvas, k1: float, k2: float, k3: float) -> Falloff:
    """Polynomial falloff: 1 + k1 r^2 + k2 r^4 + k3 r^6, r = 1 in the corners; at least 0."""
    half_diagonal = 0.5 * math.hypot(*canvas.full_size)

    def falloff(rows: Rows) -> NDArray[np.float32]:
        x, y = offsets(canvas, rows, canvas.center)
        r2 = (x * x + y * y) / np.float32(half_diagonal**2)
        return np.maximum(1 + r2 * (k1 + r2 * (k2 + r2 * k3)), 0).astype(np.float32)

    return falloff


def _make(canvas: Canvas, values: Values) -> Step:
    match values["model"]:
        case "natural":
            falloff = _natural(canvas, values)
        case "polynomial":
            falloff = radial_polynomial(canvas, values["k1"], values["k2"], values["k3"])
        case _:
            if values["lens"] is None:
                raise UsageError(
                    "vignetting: model=lens needs a lens, such as lens=double-gauss-50mm-f2"
                )
            film, lens = film_plane(canvas, values), bench(values)
            falloff = lens_light(canvas, film, lens, color=values["colour"])
    return _Vignetting(canvas, falloff, inverse=values["inverse"])


VIGNETTING = Effect(
    "vignetting",
    "light falloff toward the edge, or its removal",
    (
        Parameter(
            "model",
            "falloff: cos^4 of the angle, 1 + k1 r^2 + ..., or that of a lens",
            kind="choice",
            default="natural",
            choices=("natural", "polynomial", "lens"),
        ),
        Parameter("k1", "factor of r^2; r is 1 in the corners", default=0.0),
        Parameter("k2", "factor of r^4", default=0.0),
        Parameter("k3", "factor of r^6", default=0.0),
        FOCAL_LENGTH,
        SENSOR,
        *LENS,
        Parameter(
            "colour", "whether model=lens has a falloff for each colour", kind="flag", default=True
        ),
        Parameter("inverse", "remove the effect instead", kind="flag", default=False),
    ),
    _make,
)


@guarded(arrays=False)
def vignette(image: Image, **parameters: object) -> Image:
    """Darkens a scene-linear picture toward its edge.

    Args:
        image: Picture, shape (H, W, C): 1 or 3 colours; alpha, if present, is not changed.
        **parameters: Parameters of the effect ``vignetting``: ``model`` ("natural", "polynomial" or
            "lens"); ``focal_length`` (mm) and ``sensor`` (mm, mm); ``k1``, ``k2``, ``k3``;
            ``lens``, ``focus`` (m), ``zoom`` (mm), ``f_stop``, ``colour``.
    """
    return on_array(VIGNETTING, image, parameters)


@guarded(arrays=False)
def unvignette(image: Image, **parameters: object) -> Image:
    """Removes the effect of :func:`vignette` with the same parameters."""
    return on_array(VIGNETTING, image, {**parameters, "inverse": True})
