"""Spread of light in film: within the emulsion, and by reflection at the back of the base.

Light that passes the emulsion is scattered and meets the back of the base at an angle theta. There
it is reflected with Fresnel's reflectance (all of it beyond the critical angle) and returns to the
emulsion at r = 2 d tan(theta), for a base of thickness d. A Lambertian patch thus adds, per area,
cos^4(theta) R(theta) / (pi (2 d)^2): nearly nothing within the critical angle, and a bright ring
from there on, the halo around lamps on film.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.post.kernels import delta, radial

from .stock import Halation, Stock

Floats = NDArray[np.float32]
#: Radius of the kernel, in radii of the ring; it holds 98 % of the returned light.
_REACH = 8.0


def halo(halation: Halation, pitch_um: float) -> tuple[Floats, float]:
    """Returns the kernel of the reflected light (sum 1), and the share that is reflected.

    Args:
        halation: Base and index.
        pitch_um: Pitch of the picture's pixels on the film, um.
    """
    twice = 2 * halation.base * 1e3 / pitch_um  # px
    ring = twice / np.sqrt(halation.index**2 - 1)
    size = 2 * int(np.ceil(_REACH * ring)) + 1

    def profile(r: NDArray[np.float64]) -> NDArray[np.float64]:
        cosine = 1 / np.hypot(1, r / twice)
        return np.asarray(reflectance(cosine, halation.index) * cosine**4)

    theta = np.linspace(0, np.pi / 2, 4001)
    back = reflectance(np.cos(theta), halation.index) * np.sin(2 * theta)
    steps = np.diff(theta) * (back[1:] + back[:-1]) / 2
    return radial(size, profile), float(steps.sum())


def reflectance(cosine: NDArray[np.float64], index: float) -> NDArray[np.float64]:
    """Fresnel reflectance from the base to air, for unpolarized light."""
    sine2 = index**2 * (1 - cosine**2)
    total = sine2 >= 1
    outside = np.sqrt(np.where(total, 0, 1 - np.minimum(sine2, 1)))
    s = (index * cosine - outside) / (index * cosine + outside + 1e-300)
    p = (cosine - index * outside) / (cosine + index * outside + 1e-300)
    return np.asarray(np.where(total, 1.0, 0.5 * (s**2 + p**2)))


def kernels(stock: Stock, pitch_um: float) -> Floats | None:
    """Kernels of each layer, (h, w, C); halation makes sums exceed 1. None: no spread."""
    spread = _emulsion(stock.spread / pitch_um)
    if stock.halation is None:
        if len(spread) == 1:
            return None
        return np.repeat(spread[:, :, None], len(stock.layers), axis=2)
    ring, share = halo(stock.halation, pitch_um)
    size = max(len(spread), len(ring))
    parts = [
        _within(spread, size) + np.float32(share * layer) * _within(ring, size)
        for layer in stock.halation.share
    ]
    return np.stack(parts, axis=2)


def _emulsion(sigma_px: float) -> Floats:
    if sigma_px < 0.1:  # less than 1 % of the light leaves its pixel
        return delta(1)
    size = 2 * int(np.ceil(4 * sigma_px)) + 1
    return radial(size, lambda r: np.exp(-0.5 * (r / sigma_px) ** 2))


def _within(kernel: Floats, size: int) -> Floats:
    margin = (size - len(kernel)) // 2
    return np.pad(kernel, margin)
