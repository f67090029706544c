"""Finds straight edges of a picture that are fit for measuring sharpness.

A block with gradients in a single direction has a straight edge (structure tensor: Bigun and
Granlund 1987, Optimal orientation detection of linear symmetry). ISO 12233 requires edges that are
slanted by a few degrees against rows or columns, between two uniform sides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
#: Side of a block, px of the searched picture; blocks overlap by half.
BLOCK = 24
#: Range of slants against the nearer axis, degrees; least coherence of gradients, 0 to 1.
_SLANTS, _COHERENCE = (2.0, 20.0), 0.9
#: Largest number of candidates.
MOST = 240


@dataclass(frozen=True)
class Candidate:
    """A block with an edge.

    Attributes:
        y: Centre of the block, row of the searched picture.
        x: Its column.
        strength: Energy of its gradients.
    """

    y: int
    x: int
    strength: float


def candidates(light: Floats) -> list[Candidate]:
    """Finds blocks with one slanted edge, the strongest first.

    Args:
        light: Light, shape (H, W); reduced if the picture is large.
    """
    half = BLOCK // 2
    rows, columns = (side // half for side in light.shape)
    if rows < 2 or columns < 2:
        return []
    light = light[: rows * half, : columns * half]
    down, across = np.zeros_like(light), np.zeros_like(light)
    down[1:-1] = light[2:] - light[:-2]
    across[:, 1:-1] = light[:, 2:] - light[:, :-2]
    xx, yy, xy = (_sums(a * b, half) for a, b in ((across, across), (down, down), (across, down)))
    energy = xx + yy
    with np.errstate(invalid="ignore", divide="ignore"):
        coherence = np.hypot(xx - yy, 2 * xy) / energy
    angle = np.degrees(0.5 * np.arctan2(2 * xy, xx - yy))  # of the gradient
    slant = np.abs(np.mod(angle + 45, 90) - 45)
    fits = (coherence > _COHERENCE) & (slant > _SLANTS[0]) & (slant < _SLANTS[1])
    places = np.argwhere(fits & (energy > 0))
    order = np.argsort(-energy[tuple(places.T)])[:MOST]
    return [
        Candidate(int(y + 1) * half, int(x + 1) * half, float(energy[y, x]))
        for y, x in places[order]
    ]


def _sums(values: Floats, half: int) -> NDArray[np.float64]:
    """Sums over blocks that overlap by half, shape (rows - 1, columns - 1)."""
    height, width = values.shape
    cells = values.reshape(height // half, half, width // half, half).sum(axis=(1, 3), dtype=float)
    return np.asarray(cells[:-1, :-1] + cells[1:, :-1] + cells[:-1, 1:] + cells[1:, 1:])
