"""Draws point spread functions through focus, side by side."""

from __future__ import annotations

import numpy as np

from daguerre.analysis.pencils import Pencil
from daguerre.analysis.through_focus import Step


def pictures(light: Pencil, steps: list[Step], kind: str) -> bytes:
    """Draws PSFs side by side; returns the bytes of an ``svg``, ``png`` or ``pdf`` file."""
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
