"""Recovers the response curve of a camera from photographs of different exposure.

For pixel i in photograph j with value z and exposure t_j, g(z) = ln E_i + ln t_j, where g is the
logarithm of the light that gives z. The unknown light E_i is eliminated pixel by pixel, so that the
normal equations have only g, and every pixel can take part. Second differences of the deviation
from sRGB keep g near the sRGB curve. Source: Debevec and Malik, Recovering High Dynamic Range
Radiance Maps from Photographs, SIGGRAPH 1997, equations 3 and 4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb

from .latlong import FloatArray

NODES = 256
#: Range of values that are used; beyond are noise and clipping.
_LOW, _HIGH = 4, 249
#: Range around middle grey (118 in sRGB) in which all three curves are scaled to equal sRGB.
_GREY = slice(88, 149)
_SMOOTH = 0.1
_PIXELS = 1 << 17
_ROUNDS = 4


def srgb_curve() -> FloatArray:
    """Light of each value, 0 to 255, shape (256, 3), by the sRGB transfer function."""
    light = srgb.to_linear(np.arange(NODES) / (NODES - 1))
    return np.repeat(np.asarray(light, np.float64)[:, None], 3, axis=1)


def table(curve: FloatArray, levels: int) -> NDArray[np.float32]:
    """Light of each of ``levels`` values, shape (levels, 3)."""
    at = np.linspace(0, NODES - 1, levels)
    columns = [np.interp(at, np.arange(NODES), curve[:, c]) for c in range(3)]
    return np.stack(columns, axis=1).astype(np.float32)


def recover(pictures: list[NDArray[np.uint8]], stops: tuple[float, ...]) -> FloatArray:
    """Recovers the response curves of three channels.

    Args:
        pictures: Pictures of one view, shape (H, W, 3).
        stops: Exposure of each picture, EV.

    Returns:
        Light of each value, shape (256, 3), ascending, equal to sRGB at middle grey.
    """
    step = max(pictures[0].shape[0] * pictures[0].shape[1] // _PIXELS, 1)
    taken = [picture.reshape(-1, 3)[::step] for picture in pictures]
    offsets = np.log(2.0) * np.array(stops)
    curves = [_channel(np.stack([t[:, c] for t in taken]), offsets) for c in range(3)]
    return np.stack(curves, axis=1)


def _channel(numbers: NDArray[np.uint8], offsets: FloatArray) -> FloatArray:
    """Recovers the light of each value, shape (256,), from values (J, N)."""
    base = np.log(np.maximum(srgb_curve()[:, 0], 0.25 / 12.92 / 255))
    light = np.ones(numbers.shape)  # weights, lowered where a pixel moved
    found = base
    for _ in range(_ROUNDS):
        found = base + _solve(numbers, base, offsets, _hat()[numbers] * light)
        light = _agreeing(found[numbers] - offsets[:, None], _hat()[numbers])
    found = np.maximum.accumulate(found)
    curve = np.exp(found - np.mean((found - base)[_GREY]))
    curve[0] = 0.0
    return np.asarray(curve)


def _hat() -> FloatArray:
    """Weight of each value; 0 at both ends of the range."""
    z = np.arange(NODES)
    return np.where((z >= _LOW) & (z <= _HIGH), np.minimum(z, 255 - z) / 127.5, 0)


def _agreeing(light: FloatArray, weights: FloatArray) -> FloatArray:
    """Tukey's weights by the agreement of a pixel's light in one photograph with that in all."""
    mean = (weights * light).sum(axis=0) / np.maximum(weights.sum(axis=0), 1e-9)
    off = np.abs(light - mean)
    several = (weights > 0).sum(axis=0) > 1
    used = off[(weights > 0) & several]
    scale = 6 * 1.4826 * float(np.median(used)) if used.size else 0.0
    return np.asarray(np.maximum(1 - (off / max(scale, 0.02)) ** 2, 0) ** 2)


def _solve(
    numbers: NDArray[np.uint8], base: FloatArray, offsets: FloatArray, weights: FloatArray
) -> FloatArray:
    """Curve less ``base``, shape (256,): weighted least squares with E eliminated."""
    weights = weights * ((weights > 0).sum(axis=0) > 1)
    total = np.maximum(weights.sum(axis=0), 1e-12)
    known = offsets[:, None] - base[numbers]  # residual for the curve
    mean = (weights * known).sum(axis=0) / total
    normal = np.diag(np.bincount(numbers.ravel(), weights.ravel(), NODES)).astype(np.float64)
    right = np.bincount(numbers.ravel(), (weights * (known - mean)).ravel(), NODES)
    for a, one in zip(weights, numbers, strict=True):
        for b, other in zip(weights, numbers, strict=True):
            pair = one.astype(np.int64) * NODES + other
            normal -= np.bincount(pair, a * b / total, NODES * NODES).reshape(NODES, NODES)
    share = max(float(weights.sum()) / NODES, 1e-12)
    bend = np.diff(np.eye(NODES), 2, axis=0)
    normal += _SMOOTH * share * NODES**2 / 100 * bend.T @ bend
    normal += share / NODES  # g has an arbitrary constant
    return np.asarray(np.linalg.solve(normal + 1e-9 * share * np.eye(NODES), right))
