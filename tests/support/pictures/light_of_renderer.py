"""Light on the film as the renderer integrates it, without a picture's noise."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre import _core
from daguerre.analysis.bench import Bench
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

Array = NDArray[np.float64]
RAYS = 1 << 14
_ROOT = 1.324717957244746  # of x^3 = x + 1: Roberts's R2, points that fill a square evenly


def light_of_renderer(bench: Bench, film_mm: Array) -> Array:
    """Light of film points (N, 2) over that of the axis: means of the weights of drawn rays."""
    exact = _core.ExactLens(
        bench.lens.prescription,
        _core.ExactLensSettings(
            f_stop=bench.f_stop,
            half_diagonal_mm=1.02 * bench.field_mm,
            film_z_mm=bench.film_z,
        ),
    )
    steps = np.arange(RAYS) + 0.5
    on_lens = np.column_stack([steps / _ROOT % 1, steps / _ROOT**2 % 1]).astype(np.float32)
    nm = np.full(RAYS, DESIGN_WAVELENGTH_NM, np.float32)

    def light(point: Array) -> float:
        # The picture is upside down on the film.
        film = np.tile(np.float32(-point), (RAYS, 1))
        return float(exact.generate(film, on_lens, nm)[2].mean(dtype=np.float64))

    found = np.array([light(point) for point in np.vstack([np.zeros((1, 2)), film_mm])])
    return np.asarray(found[1:] / found[0])
