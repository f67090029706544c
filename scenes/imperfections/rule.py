"""A rule of light that runs away from the camera: what is in front of the focus, in it, behind it.

Lines of light across a dark board lie 4 cm apart; the long one is in focus, at 1.5 m. They
are so bright that their middles are white, and colour is left at their edges.
"""

from __future__ import annotations

import numpy as np

from daguerre.exporters.gltf import Glb, Shape
from imperfections.glow import COOL, WHITE, Glow
from kit import shapes

FOCUS, HEIGHT = 1.5, 0.45  # of the long line from the lens, and of the lens over the board, m
STEP, REACH = 0.04, 5  # from line to line, m, and how many there are on each side of the long one
LUMINANCE = 2.0  # cd/m2


def make() -> Glb:
    """The rule and its camera, 100 mm at f/1.3."""
    glow = Glow()
    glow.show("board", _flat(2, 3), COOL, 0.012, (0, -0.001, 0))
    for k in range(-REACH, REACH + 1):
        _line(glow, 0.0, k, 0.3 if k == 0 else 0.085)
        for side in (-1, 1) if k else ():
            _line(glow, 0.062 * side, k, 0.006)
    eye = (0.0, HEIGHT, float(np.sqrt(FOCUS**2 - HEIGHT**2)))
    glow.camera(eye, (0, 0, 0), 100, 1.3, (0, 0, 0))
    return glow.glb


def _line(glow: Glow, x: float, k: int, wide: float) -> None:
    """One line across the rule, `k` steps behind the one in focus."""
    glow.show("line", _flat(wide, 0.006), WHITE, LUMINANCE, (x, 0, -STEP * k))


def _flat(wide: float, deep: float) -> Shape:
    """A rectangle that faces +y."""
    return shapes.turned(shapes.square(wide, deep), [[1, 0, 0], [0, 0, 1], [0, -1, 0]])
