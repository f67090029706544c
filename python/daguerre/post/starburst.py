"""Stars: kernels of RGB that diffraction at an iris makes."""

from __future__ import annotations

import numpy as np

from daguerre.analysis.diffraction import Pupil, far_fields
from daguerre.colour import rgb_mixes

from .kernels import Floats


def starburst(
    pupil: Pupil, pitch_mm: float, size: int, *, wavelengths: int = 24, threads: int = 0
) -> Floats:
    """What diffraction makes of RGB light, shape (size, size, 3, 3): from last axis to axis 2.

    Each of R, G and B is taken as its emitter's spectrum, so a white lamp's star has the colours of
    white light; in the sum over the window each colour stays what it is.
    """
    nm, mixes = rgb_mixes(wavelengths)
    out = np.zeros((3, 3, size, size), np.float32)
    for mix, spread in zip(
        mixes, far_fields(pupil, nm.tolist(), pitch_mm, size, threads=threads), strict=True
    ):
        # What falls outside of the window is given to all of it: nothing is lost.
        spread *= np.float32(1 / spread.sum(dtype=np.float64))
        for j, i in np.ndindex(3, 3):
            out[j, i] += np.float32(mix[j, i]) * spread
    return np.moveaxis(out, (0, 1), (2, 3))


def tail_only(kernel: Floats, core_px: float) -> Floats:
    """A kernel (h, w, 3, 3) without its middle, each colour's sum 1 again."""
    h, w = kernel.shape[:2]
    r = np.hypot(np.arange(h)[:, None] - h // 2, np.arange(w) - w // 2)
    fade = np.clip(r / core_px - 1, 0, 1)[:, :, None, None].astype(np.float32)
    rest = kernel * fade
    return np.asarray(rest @ np.linalg.inv(rest.sum(axis=(0, 1), dtype=np.float64)), np.float32)
