"""Through-focus series: the image of a point source on films at several positions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from daguerre.files.value import BriefRecord

from .mtf import diffraction_mtf, geometric_mtf
from .pencils import Pencil
from .psf import WHITE_NM, WHITE_WEIGHTS, Psf, binned, psf_of, waves_of
from .spots import Spot, spot

PIXELS = 96
GRID = 240  # rays across, for each wavelength of a PSF of rays: few enough to see no grain


@dataclass(frozen=True, repr=False)
class Step(BriefRecord):
    """The image of a point source on one film.

    Attributes:
        dz: Shift of the film from its position, away from the lens, mm.
        psf: PSF in white light.
        rays: Spot at F, d and C.
        facts: Figures as plain values: lengths in mm, shares of the light.
    """

    dz: float
    psf: Psf
    rays: Spot
    facts: dict[str, Any]


def series(light: Pencil, count: int = 9) -> list[Step]:
    """Computes the PSF on films around the bench's film.

    From film to film, the blur changes by about the size of the sharpest PSF. All PSFs are of
    waves, or all of rays if the fringes of the widest blur are too fine to be drawn.

    Args:
        light: From ``pencil``.
        count: Number of films, odd; 1: only the bench's film.
    """
    bench, rays = light.bench, spot(light, grid=96)
    airy = 1.22e-6 * max(WHITE_NM) * bench.f_stop
    step = 1.5 * bench.f_stop * max(rays.rms, airy)
    places = [(k - count // 2) * step for k in range(count)]
    ends = [rays.moved(places[0]), rays.moved(places[-1])]
    spread = max(float(np.abs(end.points - end.centroid).max()) for end in ends)
    half = 1.1 * spread + 3 * airy
    waves = waves_of(light, WHITE_NM, half + spread, rays.centroid)
    shares = [w / sum(WHITE_WEIGHTS) for w in WHITE_WEIGHTS]
    if len(waves) == len(shares):
        psfs = [psf_of(waves, shares, half, PIXELS, rays.centroid, dz) for dz in places]
    else:
        white = spot(light, WHITE_NM, WHITE_WEIGHTS, grid=GRID, jitter=True)
        psfs = [binned(white.moved(dz), half, PIXELS) for dz in places]
    return [_step(light, rays.moved(dz), psf, dz) for dz, psf in zip(places, psfs, strict=True)]


def _step(light: Pencil, rays: Spot, psf: Psf, dz: float) -> Step:
    frequency = [10.0, 20.0, 40.0]
    if psf.diffraction:
        mtf = diffraction_mtf(light, frequency, dz=dz)
    else:
        mtf = geometric_mtf(rays, frequency)
    facts = {
        "film_mm": dz,
        "rms_mm": rays.rms,
        "radius_50_mm": rays.energy_radius(0.5),
        "radius_80_mm": rays.energy_radius(0.8),
        "centroid_mm": rays.centroid.tolist(),
        "width_mm": list(psf.line_widths),
        "diffraction": psf.diffraction,
        "mtf_10_per_mm": mtf[0].tolist(),
        "mtf_20_per_mm": mtf[1].tolist(),
        "mtf_40_per_mm": mtf[2].tolist(),
    }
    return Step(dz, psf, rays, facts)
