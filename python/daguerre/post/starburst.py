"""Stars: kernels of RGB that diffraction at an iris makes."""

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
    """Star of RGB light by diffraction, shape (size, size, 3, 3): from last axis to axis 2.

    Each of R, G and B is taken as its emitter's spectrum, so a white lamp's star has the colours of
    white light; in the sum over the window each colour stays what it is.
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
            # Light outside of the window is given to all of it: nothing is lost.
            light = light_of(kernel) if pupil.perfect else kernel.sum(dtype=np.float64)
            shares[k] = mixes[first + k].ravel() / light
        for pixels in range(0, size * columns, STRETCH):
            part = np.s_[:, pixels : pixels + STRETCH]
            out[part] += shares.T @ group[part]
    mixed = out.reshape(3, 3, size, columns)
    return np.moveaxis(both_halves(mixed) if pupil.perfect else mixed, (0, 1), (2, 3))


def tail_only(kernel: Floats, core_px: float) -> Floats:
    """A kernel (h, w, 3, 3) without its middle, each colour's sum 1 again."""
    h, w = kernel.shape[:2]
    r = np.hypot(np.arange(h)[:, None] - h // 2, np.arange(w) - w // 2)
    fade = np.clip(r / core_px - 1, 0, 1)[:, :, None, None].astype(np.float32)
    rest = kernel * fade
    if not rest.any():
        raise UsageError(
            "star: wanted a picture wide enough for light beside the star's middle, "
            f"{math.ceil(core_px)} px from it, got a kernel of {w} x {h} px"
        )
    return np.asarray(rest @ np.linalg.inv(rest.sum(axis=(0, 1), dtype=np.float64)), np.float32)
