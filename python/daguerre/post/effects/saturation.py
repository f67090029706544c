"""Vignetting of saturation: colours that fade toward the edge, and its removal."""

from __future__ import annotations

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.color.spaces import LUMINANCE_709
from daguerre.convolution.rows import Rows
from daguerre.post.array import on_array
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.lens_light import Falloff
from daguerre.post.parameter import Parameter
from daguerre.post.picture import Band, Canvas, Image

from .vignetting import radial_polynomial, reciprocal


class _Saturation(Step):
    """Moves colours toward the grey of the same luminance."""

    def __init__(self, canvas: Canvas, falloff: Falloff, *, inverse: bool) -> None:
        self._falloff, self._inverse = falloff, inverse
        self._colors = len(canvas.colors) - canvas.alpha
        self._pale = 0

    def apply(self, band: Band, rows: Rows) -> Band:
        if self._colors != 3:
            return band
        share = self._falloff(rows)
        if self._inverse:
            share, pale = reciprocal(share)
            self._pale += pale
        image = band.image.copy()
        grey = (image[:, :, :3] @ LUMINANCE_709.astype(np.float32))[:, :, None]
        image[:, :, :3] = grey + (image[:, :, :3] - grey) * share[:, :, None]
        return band.with_image(image)

    def remarks(self) -> list[str]:
        found = [f"{self._pale} pixels have no colour left and stay grey"]
        return found if self._pale else []


def _make(canvas: Canvas, values: Values) -> Step:
    falloff = radial_polynomial(canvas, values["k1"], values["k2"], values["k3"])
    return _Saturation(canvas, falloff, inverse=values["inverse"])


SATURATION = Effect(
    "saturation-vignetting",
    "saturation that falls toward the edge, or its removal",
    (
        Parameter("k1", "factor of r^2 in 1 + k1 r^2 + ...; r is 1 in the corners", default=-0.5),
        Parameter("k2", "factor of r^4", default=0.0),
        Parameter("k3", "factor of r^6", default=0.0),
        Parameter("inverse", "remove the effect instead", kind="flag", default=False),
    ),
    _make,
)


@guarded(arrays=False)
def vignette_saturation(image: Image, **parameters: object) -> Image:
    """Reduces saturation toward the edge; luminance does not change.

    Args:
        image: Scene-linear Rec.709 picture, shape (H, W, 3), or (H, W, 4) with alpha, which is not
            changed.
        **parameters: ``k1``, ``k2``, ``k3``: saturation is 1 + k1 r^2 + k2 r^4 + k3 r^6, r = 1 in
            the corners.
    """
    return on_array(SATURATION, image, parameters)


@guarded(arrays=False)
def unvignette_saturation(image: Image, **parameters: object) -> Image:
    """Removes the effect of :func:`vignette_saturation` with the same parameters."""
    return on_array(SATURATION, image, {**parameters, "inverse": True})
