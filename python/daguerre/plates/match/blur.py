"""Blur from rendered pixels to a plate's pixels: a Gaussian, then the sharpening of cameras.

The response is exp(-2 pi^2 s^2 f^2) (1 + a (1 - exp(-2 pi^2 r^2 f^2))): a Gaussian of s px, then an
unsharp mask of strength a and the radius r of development.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.development.recipe import SHARPEN_RADIUS

FloatArray = NDArray[np.float64]
Floats = NDArray[np.float32]
#: Largest sigma, px, and largest sharpening in the fit.
_MOST_SIGMA, _MOST_SHARPEN = 6.0, 4.0
#: Highest frequency in the fit, cycles per pixel; above, aliasing and noise matter.
_FITTED = 0.42


@dataclass(frozen=True)
class Blur:
    """Blur of pixels, and the sharpening after it.

    Attributes:
        sigma: Standard deviation of the Gaussian, px.
        sharpen: Strength of the unsharp mask.
    """

    sigma: float = 0.0
    sharpen: float = 0.0

    def response(self, frequency: FloatArray) -> FloatArray:
        """Modulation at frequencies, cycles per pixel."""
        mask = 1 + self.sharpen * (1 - gaussian(SHARPEN_RADIUS, frequency))
        return np.asarray(gaussian(self.sigma, frequency) * mask)

    def applied(self, planes: Floats, scale: float = 1.0) -> Floats:
        """Applies this blur to a picture; border values continue beyond the border.

        Args:
            planes: Linear light, shape (H, W, C).
            scale: Pixels of the picture for each pixel of the plate.
        """
        soft = _spread(planes, self.sigma * scale)
        if self.sharpen == 0:
            return soft
        more = np.float32(self.sharpen) * (soft - _spread(soft, SHARPEN_RADIUS * scale))
        # Sharpening must not make light negative.
        return np.where(soft >= 0, np.maximum(soft + more, 0), soft)


def gaussian(sigma: float, frequency: FloatArray) -> FloatArray:
    """Modulation of a Gaussian blur at frequencies in cycles per pixel."""
    return np.asarray(np.exp(-2 * (np.pi * sigma * frequency) ** 2))


def fitted(frequency: FloatArray, response: FloatArray, model: FloatArray | None = None) -> Blur:
    """Fits blur and sharpening that convert the response of rendered pixels to a measured response.

    Args:
        frequency: Frequencies, cycles per pixel, shape (F,).
        response: Measured modulation, shape (F,).
        model: Modulation of rendered pixels, shape (F,); None: of a square pixel.
    """
    used = (frequency > 0) & (frequency <= _FITTED)
    f, wanted = frequency[used], response[used]
    base = np.sinc(f) if model is None else model[used]
    best = (np.inf, Blur())
    for sigma in np.arange(0, _MOST_SIGMA, 0.005):
        blurred = base * gaussian(sigma, f)
        masked = blurred * (1 - gaussian(SHARPEN_RADIUS, f))
        power = float(masked @ masked)
        sharpen = float(masked @ (wanted - blurred)) / power if power > 1e-12 else 0.0
        sharpen = min(max(sharpen, 0.0), _MOST_SHARPEN)
        rest = wanted - blurred - sharpen * masked
        # Blur and sharpening cancel: among equal fits, prefer less of both.
        error = float(rest @ rest) + 1e-4 * sharpen
        if error < best[0]:
            best = (error, Blur(float(sigma), sharpen))
    return best[1]


def _spread(planes: Floats, sigma: float) -> Floats:
    weights = taps(sigma)
    reach = len(weights) // 2
    if reach == 0:
        return planes
    for axis in (0, 1):
        width = [(0, 0)] * 3
        width[axis] = (reach, reach)
        wide = np.pad(planes, width, mode="edge")
        out = np.zeros_like(planes)
        for i, weight in enumerate(weights):
            out += (
                np.float32(weight)
                * wide[(slice(None),) * axis + (slice(i, i + planes.shape[axis]),)]
            )
        planes = out
    return planes


def taps(sigma: float) -> FloatArray:
    """Non-negative weights of a blur with the Gaussian's response at 1/4 cycle per pixel.

    A Gaussian sampled at pixels has another response, above all a narrow Gaussian.
    """
    if sigma < 0.01:
        return np.ones(1)
    wanted = float(gaussian(sigma, np.array(0.25)))
    low, high = 0.0, 0.4 + sigma
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _quarter(_read(middle)) > wanted else (low, middle)
    return _read(high)


def _read(sigma: float) -> FloatArray:
    reach = max(int(np.ceil(4 * sigma)), 1)
    at = np.arange(-reach, reach + 1)
    weights = np.exp(-0.5 * (at / max(sigma, 1e-3)) ** 2)
    return np.asarray(weights / weights.sum())


def _quarter(weights: FloatArray) -> float:
    """Response at 1/4 cycle per pixel."""
    at = np.arange(len(weights)) - len(weights) // 2
    return float((weights * np.cos(np.pi / 2 * at)).sum())
