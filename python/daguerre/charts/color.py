"""Colour chart of 24 patches: two rows of natural colours, a row of strong colours, a grey row."""

from __future__ import annotations

import numpy as np

from daguerre.color import srgb

from .chart import Chart, Patch, grey, rectangle

#: sRGB, 8 bits, of the classic chart of McCamy, Marcus and Davidson 1976 ("A color-rendition
#: chart", J. Appl. Photogr. Eng. 2(3)), as its maker publishes them.
COLORS = {
    "dark skin": (115, 82, 68), "light skin": (194, 150, 130), "blue sky": (98, 122, 157),
    "foliage": (87, 108, 67), "blue flower": (133, 128, 177), "bluish green": (103, 189, 170),
    "orange": (214, 126, 44), "purplish blue": (80, 91, 166), "moderate red": (193, 90, 99),
    "purple": (94, 60, 108), "yellow green": (157, 188, 64), "orange yellow": (224, 163, 46),
    "blue": (56, 61, 150), "green": (70, 148, 73), "red": (175, 54, 60),
    "yellow": (231, 199, 31), "magenta": (187, 86, 149), "cyan": (8, 133, 161),
    "white": (243, 243, 242), "neutral 8": (200, 200, 200), "neutral 6.5": (160, 160, 160),
    "neutral 5": (122, 122, 121), "neutral 3.5": (85, 85, 85), "black": (52, 52, 52),
}  # fmt: skip
COLUMNS, ROWS = 6, 4
_GAP = 0.12  # of a field


def make(width: float = 0.9) -> Chart:
    """A color chart of 24 patches, 3 : 2.

    Args:
        width: Width of the chart, m.
    """
    field = width / (COLUMNS + 0.8)
    top_left = np.array([-(COLUMNS - 1) / 2, (ROWS - 1) / 2 * 1.0]) * field
    patches, truth = [], []
    for i, (name, code) in enumerate(COLORS.items()):
        center = top_left + field * np.array([i % COLUMNS, -(i // COLUMNS)])
        r, g, b = (linear(value) for value in code)
        side = field * (1 - _GAP)
        patches.append(Patch(name, rectangle(center, (side, side)), (r, g, b)))
        truth.append({"name": name, "center_m": center.tolist(), "side_m": side, "rgb": [r, g, b]})
    return Chart("colour", (width, width / 1.5), tuple(patches), grey(0.015), {"patches": truth})


def linear(code: int) -> float:
    """Linear light of an sRGB code value."""
    return float(srgb.to_linear(np.asarray(code / 255)))
