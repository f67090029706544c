"""Draws point spread functions through focus, side by side."""

from __future__ import annotations

import numpy as np

from daguerre.analysis.pencils import Pencil
from daguerre.analysis.through_focus import Step

SIDE, WIDTH, GAP, HEAD = 2.2, 4.6, 0.06, 0.42  # of a PSF and of all at least, inches


def pictures(light: Pencil, steps: list[Step], kind: str) -> bytes:
    """Draws PSFs side by side; returns the bytes of an ``svg``, ``png`` or ``pdf`` file.

    Each is drawn up to its own peak, so that the widest shows its shape as well as the sharpest.
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    from .sheet import STYLE, saved

    columns = min(len(steps), 3)
    rows = -(-len(steps) // columns)
    panel = max(SIDE, WIDTH / columns)
    bench = light.bench
    with rc_context(STYLE):
        width, height = columns * (panel + GAP) - GAP, rows * (panel + GAP) + HEAD
        figure = Figure(figsize=(width, height))
        figure.subplots_adjust(0, 0, 1, 1 - HEAD / height, GAP / panel, GAP / panel)
        half = steps[0].psf.half_mm
        how = "waves" if steps[0].psf.diffraction else "rays"
        figure.text(
            0.5,
            1 - 0.5 * HEAD / height,
            f"{bench.lens.name}, f/{bench.f_stop:.3g}: a point {np.degrees(light.angle):.1f}° off, "
            f"{light.film[1]:.1f} mm on the film\n"
            f"Each box is {2e3 * half:.0f} µm wide; by {how}",
            size=8,
            ha="center",
            va="center",
        )
        for k, step in enumerate(steps):
            axes = figure.add_subplot(rows, columns, k + 1)
            axes.set_axis_off()
            image = np.sqrt(step.psf.image / (step.psf.image.max() or 1.0))
            axes.imshow(image, origin="lower", cmap="inferno", vmin=0, vmax=1, aspect="auto")
            says = f"film {step.dz:+.2f} mm" if step.dz else "in focus"
            if len(steps) > 1:
                axes.text(0.04, 0.93, says, transform=axes.transAxes, size=10, color="w", va="top")
        return saved(figure, kind, bench.lens.name)
