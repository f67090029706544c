"""A point of light on a series of films, in numbers and in pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .mtf import diffraction_mtf, geometric_mtf
from .pencil import Pencil
from .psf import Psf, point_spread
from .spots import Spot, spot

PIXELS = 96


@dataclass(frozen=True)
class Step:
    """The point on one film.

    Attributes:
        dz: Of the film, mm from its place, away from the lens.
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

    Steps are so that the blur of each differs from the next by about the size of the sharpest.

    Args:
        light: From ``pencil``.
        count: Films, an odd number.
    """
    bench = light.bench
    sharp = max(spot(light).rms, 1.22e-6 * 555 * bench.f_stop)
    step = 1.5 * bench.f_stop * sharp
    half = None
    if count > 1:  # one scale for all, that of the widest
        ends = [spot(light).moved(s * step * (count // 2)) for s in (-1, 1)]
        half = 1.1 * max(float(np.abs(e.points - e.centroid).max()) for e in ends)
    return [_step(light, (k - count // 2) * step, half) for k in range(count)]


def _step(light: Pencil, dz: float, half_mm: float | None) -> Step:
    psf = point_spread(light, pixels=PIXELS, half_mm=half_mm, dz=dz)
    rays = spot(light, grid=96).moved(dz)
    frequency = [10.0, 20.0, 40.0]
    mtf = (
        diffraction_mtf(light, frequency, dz=dz)
        if psf.diffraction
        else geometric_mtf(rays, frequency)
    )
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
        figure = Figure(figsize=(2.3 * columns + 0.4, 2.5 * rows + 0.5))
        figure.suptitle(
            f"{bench.lens.name}, f/{bench.f_stop:.3g}, {np.degrees(light.angle):.1f}°, "
            f"{light.film[1]:.1f} mm",
            size=8,
        )
        for k, step in enumerate(steps):
            axes = figure.add_subplot(rows, columns, k + 1)
            half = step.psf.half_mm
            box(axes, half)
            axes.grid(visible=False)
            image = np.sqrt(step.psf.image / max(step.psf.image.max(), 1e-30))
            axes.imshow(image, extent=(-half, half, -half, half), origin="lower", cmap="inferno")
            how = "waves" if step.psf.diffraction else "rays"
            axes.set_xlabel(f"film {step.dz:+.3f} mm, box {2e3 * half:.0f} µm, {how}")
        return saved(figure, kind, bench.lens.name)
