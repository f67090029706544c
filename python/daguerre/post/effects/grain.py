"""Film grain, from randomly placed grains.

The film is a Boolean model (Newson, Delon and Galerne 2017, A stochastic film grain model for
resolution-independent rendering): round grains at random positions, their number proportional to
the light; they may overlap. If q is the mean number of grains over a point, 1 - exp(-q) of the film
is covered. The covered share of a pixel of area A, converted back to light, has the relative
variance

    (a / A) G(q) / q^2,   G(q) = 2 Integral_0^2 (exp(q k(s)) - 1) s ds,

where a is the area of a grain and k(s) the overlap of two grains at a distance of s radii. The
variance is largest in shadows, where grains are few, and smallest at q = 2.9; beyond, the film
saturates. Many grains per pixel are assumed, so that the noise is normal, and lognormal in light:
light stays positive and keeps its mean.
"""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre._core import grain_pattern
from daguerre.argument_checks import guarded
from daguerre.convolution.rows import Rows
from daguerre.post.array import on_array
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.optics import SENSOR, film_plane
from daguerre.post.parameter import Parameter
from daguerre.post.picture import Band, Canvas, Image

Floats = NDArray[np.float64]


class _Grain(Step):
    def __init__(self, canvas: Canvas, values: Values) -> None:
        self._colors = len(canvas.colors) - canvas.alpha
        self._corner = canvas.corner
        pitch_um = 1e3 * film_plane(canvas, values).pitch_mm
        self._radius = 0.5 * values["size"] / pitch_um
        self._white = values["white"]
        self._seed, self._each = values["seed"], values["colour"]

    def apply(self, band: Band, rows: Rows) -> Band:
        image = band.image.copy()
        height, width = image.shape[:2]
        x, y = self._corner[0], self._corner[1] + rows.begin
        pattern = None
        for k in range(self._colors):
            if pattern is None or self._each:
                pattern = grain_pattern(x, y, width, height, self._radius, self._seed, k)
            image[:, :, k] *= self._factor(image[:, :, k], pattern)
        return band.with_image(image)

    def _factor(self, light: Image, pattern: Image) -> Image:
        """Factor of grain on light: lognormal, with mean 1."""
        with np.errstate(invalid="ignore"):
            variance = relative_variance(np.maximum(light, 0) / self._white)
        variance *= math.pi * self._radius**2 * sharpness(self._radius)
        spread = np.log1p(np.minimum(variance, 1))
        return np.asarray(np.exp(np.sqrt(spread) * pattern - 0.5 * spread), np.float32)


def relative_variance(grains: NDArray[Any]) -> Floats:
    """Relative variance of light read from film, times pixel area over grain area: G(q) / q^2.

    Args:
        grains: Mean number of grains over a point, q. Beyond q of the smallest variance, that
            variance is kept, as film has finer grains for such light.
    """
    q, variance = _table()
    least = int(np.argmin(variance))
    clipped = np.clip(grains, q[0], q[least])
    return np.asarray(np.exp(np.interp(np.log(clipped), np.log(q), np.log(variance))), np.float64)


@functools.cache
def _table() -> tuple[Floats, Floats]:
    q = np.geomspace(1e-6, 10, 400)
    s = (np.arange(400) + 0.5) / 200
    shared = 2 / np.pi * (np.arccos(s / 2) - s / 2 * np.sqrt(1 - s * s / 4))
    return q, 2 * (np.expm1(q[:, None] * shared) * s).mean(axis=1) * 2 / q**2


@functools.cache
def sharpness(radius: float) -> float:
    """Share of the variance that remains when grains extend over pixel edges.

    It is the sum over pixels of the squared shares of a grain of this radius (px).
    """
    reach, fine = math.ceil(radius + 0.5), 32
    at = (np.arange((2 * reach + 1) * fine) + 0.5) / fine - reach - 0.5
    side = 2 * reach + 1
    inside = (at[:, None] ** 2 + at**2 <= max(radius, 0.1) ** 2).astype(float)
    parts = inside.reshape(side, fine, side, fine).sum(axis=(1, 3)) / inside.sum()
    return float((parts**2).sum())


GRAIN = Effect(
    "grain",
    "grain of photographic film; applied after all other effects",
    (
        Parameter("size", "grain diameter on the film", "um", 2.0, low=0.01, high=1000),
        Parameter("white", "value that covers 63 % of the film with grains", "", 1.0, low=1e-6),
        SENSOR,
        Parameter("colour", "whether each colour has its own pattern", "", True, "flag"),
        Parameter("seed", "random seed of the pattern", "", 0, "whole", low=0, high=2**53),
    ),
    _Grain,
    last=True,
)


@guarded(arrays=False)
def grain(image: Image, **parameters: object) -> Image:
    """Adds film grain to a scene-linear picture; the mean of the light does not change.

    A pixel has the same grain in every crop of a picture.

    Args:
        image: Picture, shape (H, W, C): 1 or 3 colours; alpha, if present, is not changed.
        **parameters: Parameters of the effect ``grain``: ``size`` (um), ``sensor`` (mm, mm),
            ``white``, ``colour``, ``seed``.

    Raises:
        UsageError: A parameter is wrong or missing.
    """
    return on_array(GRAIN, image, parameters)
