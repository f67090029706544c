"""Grey step wedge: equal steps in density, for tone curves and noise (ISO 14524, ISO 15739)."""

from __future__ import annotations

import math

import numpy as np

from daguerre.checks import number, whole

from .chart import Chart, Patch, grey, rectangle


def make(width: float = 0.9, steps: int = 20, step: float = 0.1, first: float = 0.05) -> Chart:
    """Rows of patches, from light to dark: density first + i step, light 10^-density of white.

    Args:
        width: Width of the chart, m.
        steps: Number of patches, 2 to 100.
        step: Step of density.
        first: Density of the lightest patch.
    """
    steps = whole(steps, "chart: steps", 2, 100)
    number(step, "chart: step", 0, 1, above=0)
    number(first, "chart: first", 0, 5)
    columns = math.ceil(math.sqrt(1.5 * steps))
    rows = math.ceil(steps / columns)
    height = width / 1.5
    field = min(width / (columns + 0.5), height / (rows + 0.5))
    top_left = field * np.array([-(columns - 1) / 2, (rows - 1) / 2])
    patches, truth = [], []
    for i in range(steps):
        density = first + i * step
        center = top_left + field * np.array([i % columns, -(i // columns)])
        side, share = 0.9 * field, 10**-density
        patches.append(Patch(f"step {i}", rectangle(center, (side, side)), grey(share)))
        truth.append(
            {
                "name": f"step {i}",
                "center_m": center.tolist(),
                "side_m": side,
                "rgb": [share] * 3,
                "density": density,
            }
        )
    return Chart("step-wedge", (width, height), tuple(patches), grey(0.18), {"patches": truth})
