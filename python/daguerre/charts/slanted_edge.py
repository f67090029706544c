"""Slanted squares over the field, for the spatial frequency response of edges (ISO 12233)."""

from __future__ import annotations

import numpy as np

from daguerre.checks import number

from .chart import Chart, Patch, grey, rectangle

COLUMNS, ROWS = 5, 3


def make(
    width: float = 0.9, angle: float = 5.0, contrast: float = 4.0, white: float = 0.8
) -> Chart:
    """Makes slanted edges: 5 x 3 dark squares on a light ground.

    Args:
        width: Width of the chart, m.
        angle: Rotation of the squares counter-clockwise, degrees, 1 to 44.
        contrast: Ratio of the light of the ground to the light of the squares; 4 in ISO 12233.
        white: Light of the ground, as a share of the chart's white.
    """
    number(angle, "chart: angle", 1, 44)
    number(white, "chart: white", 0, 1, above=0)
    number(contrast, "chart: contrast", 1, 1e6, above=1)
    height = width / 1.5
    apart = np.array([width / COLUMNS, height / ROWS])
    side = 0.55 * float(apart.min())
    patches, truth = [], []
    for row in range(ROWS):
        for column in range(COLUMNS):
            center = apart * [column - (COLUMNS - 1) / 2, (ROWS - 1) / 2 - row]
            points = rectangle(center, (side, side), angle)
            name = f"{column},{row}"
            patches.append(Patch(name, points, grey(white / contrast)))
            truth.append({"name": name, "center_m": center.tolist(), "edges": _edges(points)})
    facts = {"angle_deg": angle, "contrast": contrast, "side_m": side, "squares": truth}
    return Chart("slanted-edge", (width, height), tuple(patches), grey(white), facts)


def _edges(points: np.ndarray) -> dict[str, list[list[float]]]:
    """End points of edges, by side of the square."""
    names = ("bottom", "right", "top", "left")
    return {
        name: [points[i].tolist(), points[(i + 1) % 4].tolist()] for i, name in enumerate(names)
    }
