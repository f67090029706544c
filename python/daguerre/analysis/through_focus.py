"""A point of light on a series of films, in numbers and in pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .mtf import diffraction_mtf, geometric_mtf
from .pencils import Pencil
from .psf import WHITE_NM, WHITE_WEIGHTS, Psf, geometric_psf, psf_of, waves_of
from .spots import Spot, spot

PIXELS = 96


@dataclass(frozen=True)
class Step:
    """The point on one film.

    Attributes:
        dz: Shift of the film from its place, away from the lens, mm.
        psf: In white light.
        rays: F, d and C.
        facts: Figures for programs: mm, shares.
    """

    dz: float
    psf: Psf
    rays: Spot
    facts: dict[str, Any]


def series(light: Pencil, count: int = 9) -> list[Step]:
    """The PSF on films around that of the bench; one only: on that film.

    Steps are so that the blur of each differs from the next by about the size of the sharpest. All
    are of waves, or all of rays where the widest blur has fringes too fine to be drawn.

    Args:
        light: From ``pencil``.
        count: Films, an odd number.
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
    out = []
    for dz in places:
        if len(waves) == len(shares):
            psf = psf_of(waves, shares, half, PIXELS, rays.centroid, dz)
        else:
            psf = geometric_psf(light, half_mm=half, pixels=PIXELS, dz=dz)
        out.append(_step(light, rays.moved(dz), psf, dz))
    return out


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


def pictures(light: Pencil, steps: list[Step], kind: str) -> bytes:
    """The PSFs side by side as a file's bytes: ``svg``, ``png`` or ``pdf`` (extra ``plot``)."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    from .panels import box
    from .sheet import STYLE, saved

    columns = min(len(steps), 3)
    rows = -(-len(steps) // columns)
    bench = light.bench
    with rc_context(STYLE):
        size = (2.3 * columns + 0.3, 2.55 * rows + 0.4)
        figure = Figure(figsize=size)
        figure.subplots_adjust(0.2 / size[0], 0.3 / size[1], 1 - 0.2 / size[0], 1 - 0.4 / size[1])
        brightest = max(float(step.psf.image.max()) for step in steps)
        figure.suptitle(
            f"{bench.lens.name}, f/{bench.f_stop:.3g}, {np.degrees(light.angle):.1f}°, "
            f"{light.film[1]:.1f} mm",
            size=8,
            y=1 - 0.12 / size[1],
        )
        for k, step in enumerate(steps):
            axes = figure.add_subplot(rows, columns, k + 1)
            half = step.psf.half_mm
            box(axes, half)
            axes.grid(visible=False)
            axes.imshow(
                np.sqrt(step.psf.image / brightest),
                extent=(-half, half, -half, half),
                origin="lower",
                cmap="inferno",
                vmin=0,
                vmax=1,
            )
            how = "waves" if step.psf.diffraction else "rays"
            axes.set_xlabel(f"film {step.dz:+.3f} mm, box {2e3 * half:.0f} µm, {how}")
        return saved(figure, kind, bench.lens.name)
