"""The MTF of one object point over frequency, as a result that plots itself."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from daguerre.argument_checks import guarded
from daguerre.checks import line
from daguerre.files.value import BriefRecord

from .bench import FloatArray
from .mtf import diffraction_mtf, geometric_mtf
from .pencils import Pencil
from .plotted import Plotted
from .spots import spot

#: Spatial frequencies if none are given, cycles per mm.
FREQUENCIES = np.linspace(0, 80, 33)
GRID = 64  # rays across


@guarded
@dataclass(frozen=True, repr=False)
class Mtf(BriefRecord, Plotted):
    """Modulation transfer function of one object point.

    Attributes:
        freq_per_mm: Spatial frequencies, cycles per mm, shape (F,).
        waves: MTF with diffraction, in [0, 1], shape (F, 2): sagittal, tangential.
        rays: The same of rays alone.
    """

    freq_per_mm: FloatArray
    waves: FloatArray
    rays: FloatArray


@guarded
def modulation_transfer(light: Pencil, freq_per_mm: ArrayLike = FREQUENCIES) -> Mtf:
    """Computes the MTF of F, d and C as the eye weights them, of waves and of rays.

    Args:
        light: From ``pencil``.
        freq_per_mm: Spatial frequencies, cycles per mm, shape (F,).
    """
    f = line(freq_per_mm, "modulation_transfer: freq_per_mm")
    rays = geometric_mtf(spot(light, grid=GRID, jitter=True), f)
    return Mtf(f, diffraction_mtf(light, f), rays)
