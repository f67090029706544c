"""Merges photographs of different exposure to one picture of linear light.

Each pixel is the mean over the photographs, weighted by the inverse of its variance: shot noise,
read noise and rounding. Clipped pixels have weight 0. Source of the weights: Granados et al.,
Optimal HDR reconstruction with linear digital cameras, CVPR 2010.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import response
from .exposures import Exposures
from .latlong import FloatArray
from .shots import CLIPPED, Shot

#: Variance of a value v of a typical camera, in shares of white: shot noise (times v), read noise.
_PHOTONS, _READING = 1e-4, 4e-8
#: Share of saturation from which on the weight of a photograph falls to 0.
_FADE = 0.9


@dataclass(frozen=True)
class Merged:
    """Linear light of a view.

    Attributes:
        light: Rec.709 in cd/m2 or in an unknown unit, float32, shape (H, W, 3).
        clipped: Mask of pixels that are clipped in every photograph, shape (H, W).
        negative: Number of pixels with negative light in a channel, which is set to 0.
    """

    light: NDArray[np.float32]
    clipped: NDArray[np.bool_]
    negative: int


def merge(shots: list[Shot], exposures: Exposures, curve: FloatArray) -> Merged:
    """Merges all photographs of a view.

    Args:
        shots: Photographs of one size.
        exposures: Exposures of the photographs.
        curve: Response curve of encoded photographs: light of each value, shape (256, 3).
    """
    shape = shots[0].numbers.shape
    sums: NDArray[Any] = np.zeros(shape)
    weights = np.zeros(shape[:2])
    darkest = int(np.argmax(exposures.luminance))
    clipped = np.ones(shape[:2], bool)
    for i, (shot, unit) in enumerate(zip(shots, exposures.luminance, strict=True)):
        light, variance, top = _linear(shot, curve), _variance(shot, curve), shot.top
        weight = _say(top) / (variance * unit**2)
        if i == darkest:  # used where all others are clipped
            weight = np.maximum(weight, 1e-12 / unit**2)
            clipped &= top >= CLIPPED
        else:
            clipped &= top >= _FADE
        sums += weight[..., None] * light * unit
        weights += weight
    sums = np.asarray(light * unit if len(shots) == 1 else sums / weights[..., None])
    rgb = shots[0].rgb
    if rgb is not None:
        sums = sums @ rgb.T
    negative = int((sums < -0.01 * sums.mean()).any(axis=2).sum())
    return Merged(np.maximum(sums, 0).astype(np.float32), clipped, negative)


def _linear(shot: Shot, curve: FloatArray) -> NDArray[np.float32]:
    """Light of each channel; white is 1."""
    if not shot.coded:
        return np.asarray(shot.numbers, np.float32)
    lut = response.table(curve, int(shot.full[0]) + 1)
    return np.stack([lut[shot.numbers[..., c], c] for c in range(3)], axis=2)


def _variance(shot: Shot, curve: FloatArray) -> NDArray[np.float32]:
    """Variance of green, in shares of white squared, shape (H, W)."""
    if not shot.coded:
        return np.asarray(_PHOTONS * shot.numbers[..., 1] + _READING, np.float32)
    lut = response.table(curve, int(shot.full[0]) + 1)[:, 1]
    rounding = np.maximum(np.gradient(lut), 1e-7) ** 2 / 12
    return np.asarray((_PHOTONS * lut + _READING + rounding)[shot.numbers[..., 1]], np.float32)


def _say(top: NDArray[np.float32]) -> NDArray[np.float32]:
    """Factor on a photograph's weight, which falls near saturation."""
    t = np.clip((CLIPPED - top) / (CLIPPED - _FADE), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))
