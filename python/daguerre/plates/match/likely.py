"""Tells noise from fine texture, by its size and its colours.

Even texture (distant grass, plaster, felt) looks like noise in flat blocks. Two signs reveal it.
First, photosites are independent, so slow changes of red do not follow changes of green, while
texture is dark and light in all colours at once. Second, the number of electrons, from ISO and
pixel size, limits the noise. Noise that is alike in all colours (cameras that smooth colours, mono
sensors) does not exceed that limit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb
from daguerre.plates.photograph import Photograph, encoded

from .flat_blocks import LEAST, FlatBlocks, alike, rounding
from .grain import SIDE

FloatArray = NDArray[np.float64]
#: Electrons that 1 um^2 gives for 1 lx s: sensors of the library have 1400 to 3600 (mono 10000).
_YIELD = 2000.0
#: White of a picture is 78 lx s / ISO (ISO 12232).
_WHITE_LX_S = 78.0
#: Noise in the dark: electrons, and a share of white.
_DARK, _DARK_SHARE = 3.0, 1e-4
#: Largest credible pixel pitch, um; crops seem to have larger pixels.
_LARGEST = 6.0
#: Largest deviation over shot noise where the correlation of red and green is ``_ALIKE``; a lower
#: correlation allows more. Developed shots by the library's sensors have up to 2.4 at -0.7 to
#: -0.2, its mono sensors up to 1.2 at 1.
_MOST, _ALIKE = 1.5, 0.5
#: Correlation of noise by chance; up to this, a block is not texture, unless most others are.
_HARDLY, _HARDLY_IN_TEXTURE = 0.15, 0.08
_BINS = 16


@dataclass(frozen=True)
class Signs:
    """Signs of texture in blocks that look flat.

    Attributes:
        times: Median ratio of their standard deviation to that expected from electrons.
        alike: Correlation of the slow changes of their colours.
    """

    times: float
    alike: float

    @property
    def limit(self) -> float:
        """Largest ratio of the standard deviation of noise to that expected from electrons."""
        return np.inf if self.alike < _HARDLY else _MOST * _ALIKE / min(self.alike, _ALIKE)


def white_electrons(iso: float, pixel_um: float) -> float:
    """Electrons of a white pixel of a typical sensor."""
    return _YIELD * _WHITE_LX_S / iso * min(pixel_um, _LARGEST) ** 2


def likely(
    photograph: Photograph, found: FlatBlocks, electrons: float
) -> tuple[FlatBlocks | None, Signs | None]:
    """Selects flat blocks with noise rather than texture.

    Args:
        photograph: Display-encoded picture.
        found: Its flat blocks.
        electrons: Electrons of a white pixel.

    Returns:
        Blocks at credible levels, or None if too few are left; and the signs of the others, or
        None if all are credible.
    """
    order = np.argsort(found.level.mean(axis=1))
    noise = expected(found.level[:, 1], electrons) + rounding(photograph)
    times = np.sqrt(found.variance[:, 1] / noise)
    parts = np.array_split(order, max(min(_BINS, len(order) // LEAST), 1))
    parts = [part[alike(times[part] ** 2)] for part in parts]
    signs = [
        Signs(float(np.median(times[part])), _likeness(photograph, found.only(part)))
        for part in parts
    ]
    faults = [sign for sign in signs if sign.times > sign.limit]
    mostly = 2 * len(faults) > len(parts)  # then the rest is probably weak texture
    good = [
        part
        for part, sign in zip(parts, signs, strict=True)
        if sign.times <= sign.limit and not (mostly and sign.alike > _HARDLY_IN_TEXTURE)
    ]
    middle = sorted(faults, key=lambda one: one.times)[len(faults) // 2] if faults else None
    kept = np.sort(np.concatenate([np.zeros(0, np.intp), *good]))
    return (found.only(kept) if len(kept) >= LEAST else None), middle


def expected(level: FloatArray, electrons: float) -> FloatArray:
    """Display-encoded variance due to electrons and read noise, shape of the levels."""
    light = np.maximum(srgb.to_linear(level), 1e-6)
    slope = (srgb.from_linear(light * 1.001) - srgb.from_linear(light * 0.999)) / (0.002 * light)
    dark = np.hypot(_DARK / electrons, _DARK_SHARE)
    return np.asarray(slope**2 * (light / electrons + dark**2))


def _likeness(photograph: Photograph, part: FlatBlocks) -> float:
    """Mean correlation of slow changes of green with red and blue."""
    pixels = photograph.pixels
    assert pixels is not None
    blocks = np.stack([pixels[y : y + SIDE, x : x + SIDE] for y, x in part.corner])
    window = np.hanning(SIDE + 1)[:SIDE]
    light = encoded(blocks)
    light = light - light.mean(axis=(1, 2), keepdims=True)
    waves = np.fft.fft2(light * (window[:, None] * window)[:, :, None], axes=(1, 2))
    slow = np.r_[waves[:, 2:5, :5].reshape(-1, 3), waves[:, -4:-1, 1:5].reshape(-1, 3)]
    power = (slow[:, :, None] * slow[:, None].conj()).real.sum(axis=0)
    own = np.sqrt(np.maximum(np.diag(power), 1e-30))
    return float((power / np.outer(own, own))[1, [0, 2]].mean())
