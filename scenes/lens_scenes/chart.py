"""A test chart: a star, lines of several widths, slanted edges, colours and a grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.float64]

WIDE, HIGH = 680, 960  # 4 px per mm
WHITE, BLACK = 0.88, 0.04
COLORS = [(0.8, 0.1, 0.1), (0.9, 0.75, 0.1), (0.1, 0.55, 0.2), (0.1, 0.3, 0.75), (0.5, 0.5, 0.5)]


def chart() -> Picture:
    """The sheet, sRGB, shape (960, 680, 3)."""
    sheet = np.full((HIGH, WIDE, 3), WHITE)
    y, x = np.mgrid[:HIGH, :WIDE] + 0.5
    _star(sheet, x - WIDE / 2, y - 340)
    for k, width in enumerate((2, 3, 4, 6, 8, 12)):  # 0.5 to 3 mm
        _lines(sheet, 40 + 102 * k, 640, width)
    for k, color in enumerate(COLORS):
        sheet[860:920, 40 + 120 * k : 160 + 120 * k] = color
    for at in ((70, 90), (WIDE - 70, 90)):
        _slanted(sheet, x - at[0], y - at[1])
    sheet[:8] = sheet[-8:] = BLACK
    sheet[:, :8] = sheet[:, -8:] = BLACK
    return sheet


def _star(sheet: Picture, x: Picture, y: Picture, radius: float = 270, spokes: int = 36) -> None:
    """Siemens's star."""
    dark = np.sin(spokes * np.arctan2(y, x)) > 0
    r = np.hypot(x, y)
    sheet[(r < radius) & dark] = BLACK
    sheet[np.abs(r - radius) < 2] = BLACK


def _lines(sheet: Picture, left: int, top: int, width: int, size: int = 86) -> None:
    """Lines across and lines down, as wide as the gaps between them, px."""
    on = (np.arange(size) // width) % 2 == 0
    sheet[top : top + size, left : left + size][:, on] = BLACK
    sheet[top + 100 : top + 100 + size, left : left + size][on] = BLACK


def _slanted(sheet: Picture, x: Picture, y: Picture, half: float = 40) -> None:
    """A square turned by 5 degrees: its edges give the MTF (ISO 12233)."""
    c, s = np.cos(np.radians(5)), np.sin(np.radians(5))
    sheet[np.maximum(np.abs(c * x - s * y), np.abs(s * x + c * y)) < half] = BLACK
