"""Diffraction stars: RGB kernels of an iris."""

from __future__ import annotations

import math
from itertools import islice

import numpy as np

from daguerre.analysis.diffraction import Pupil, both_halves, far_fields, light_of
from daguerre.color.spectra import rgb_mixes
from daguerre.errors import UsageError

from .kernels import Floats

AT_ONCE = 6  # wavelengths
STRETCH = 1 << 14  # pixels that are mixed at a time, to save memory


def starburst(
    pupil: Pupil, pitch_mm: float, size: int, *, wavelengths: int = 24, threads: int = 0
) -> Floats:
    """Diffraction kernel for RGB, shape (size, size, 3, 3): from channels of axis 3 to axis 2.

    R, G and B each have their emitter's spectrum, so the star of a white lamp has the colours of
    white light. Summed over the window, each colour is unchanged.
    """
    nm, mixes = rgb_mixes(wavelengths)
    spreads = far_fields(pupil, nm.tolist(), pitch_mm, size, threads=threads)
    columns = size // 2 + 1 if pupil.perfect else size
    out = np.zeros((9, size * columns), np.float32)
    group = np.zeros((AT_ONCE, size * columns), np.float32)
    for first in range(0, wavelengths, AT_ONCE):
        shares = np.zeros((AT_ONCE, 9), np.float32)
        for k, kernel in enumerate(islice(spreads, AT_ONCE)):
            group[k] = kernel.ravel()
            # Light outside the window is spread evenly over it, so that none is lost.
            light = light_of(kernel) if pupil.perfect else kernel.sum(dtype=np.float64)
            shares[k] = mixes[first + k].ravel() / light
        for pixels in range(0, size * columns, STRETCH):
            part = np.s_[:, pixels : pixels + STRETCH]
            out[part] += shares.T @ group[part]
    mixed = out.reshape(3, 3, size, columns)
    return np.moveaxis(both_halves(mixed) if pupil.perfect else mixed, (0, 1), (2, 3))


def tail_only(kernel: Floats, core_px: float) -> Floats:
    """Kernel (h, w, 3, 3) without its core, scaled to sum 1 in each colour."""
    h, w = kernel.shape[:2]
    r = np.hypot(np.arange(h)[:, None] - h // 2, np.arange(w) - w // 2)
    fade = np.clip(r / core_px - 1, 0, 1)[:, :, None, None].astype(np.float32)
    rest = kernel * fade
    if not rest.any():
        raise UsageError(
            "star: wanted a kernel that reaches beyond the star's core of "
            f"{math.ceil(core_px)} px, got {w} x {h} px: the picture is too small"
        )
    return np.asarray(rest @ np.linalg.inv(rest.sum(axis=(0, 1), dtype=np.float64)), np.float32)
