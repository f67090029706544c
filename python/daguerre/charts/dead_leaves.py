"""Dead leaves: discs of all sizes over each other, as natural pictures have them (ISO 19567-2).

Source: Lee, Mumford and Huang 2001, Occlusion models for natural images, IJCV 41; Cao, Guichard and
Hornung 2009, Measuring texture sharpness of a digital camera, Proc. SPIE 7250.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import number, whole
from daguerre.errors import UsageError

from .chart import Chart, Patch, grey

GREYS = 64
_GRID = 1536  # cells across, for the visibility of leaves


def make(
    width: float = 0.9,
    seed: int = 0,
    smallest: float = 0.002,
    largest: float = 0.25,
    contrast: float = 0.5,
) -> Chart:
    """Makes dead leaves: discs with radii distributed as r^-3, so that all scales look alike.

    Their light is distributed uniformly around 0.5.

    Args:
        width: Width of the chart, m.
        seed: Seed of positions, sizes and greys.
        smallest: Smallest radius, in heights of the chart.
        largest: Largest radius, in heights of the chart.
        contrast: Half the range of light over its mean.
    """
    whole(seed, "chart: seed", 0, 2**63)
    number(contrast, "chart: contrast", 0, 1, above=0)
    number(smallest, "chart: smallest", 1e-3, 0.5)
    number(largest, "chart: largest", 1e-3, 2)
    if not smallest < largest:
        raise UsageError(
            f"chart: smallest: wanted less than largest, got {smallest:g} and {largest:g}"
        )
    height = width / 1.5
    leaves = _seen(np.random.default_rng(seed), smallest, largest)
    levels = 0.5 * (1 + contrast * (2 * (np.arange(GREYS) + 0.5) / GREYS - 1))
    patches = tuple(
        Patch("leaf", height * _disc(x, y, r), grey(float(levels[int(shade)])), int(layer))
        for x, y, r, shade, layer in leaves
    )
    facts = {
        "seed": seed,
        "leaves": len(patches),
        "radii_m": [smallest * height, largest * height],
        "mean": 0.5,
        "standard_deviation": float(levels.std()),
    }
    return Chart("dead-leaves", (width, height), patches, grey(0.5), facts)


def _seen(rng: np.random.Generator, smallest: float, largest: float) -> list[NDArray[np.float64]]:
    """Leaves that are at least partly visible: x, y, radius, shade, layer; in heights of the chart.

    They are drawn from front to back until they cover the ground. Then each is put one layer above
    the highest that it may touch, so that there are few layers.
    """
    free = np.ones((_GRID * 2 // 3, _GRID), bool)
    kept: list[NDArray[np.float64]] = []
    left = free.size
    while left > 0:
        radii = _radii(rng.random(4096), smallest, largest)
        places = (rng.random((4096, 2)) - 0.5) * (np.array([1.5, 1.0]) + 2 * largest)
        shades = rng.integers(GREYS, size=4096)
        for (x, y), r, shade in zip(places, radii, shades, strict=True):
            cells, inside = _cells(x, y, r)
            seen = free[cells] & inside
            if not seen.any():
                continue
            kept.append(np.array([x, y, r, shade, 0.0]))
            left -= int(seen.sum())
            free[cells] &= ~inside
            if left == 0:
                break
    top = np.zeros(free.shape, np.int32)
    for leaf in reversed(kept):  # from the back
        cells, _ = _cells(leaf[0], leaf[1], leaf[2] + 2 / _GRID)
        leaf[4] = top[cells].max(initial=0) + 1
        top[cells] = np.maximum(top[cells], int(leaf[4]))
    return kept[::-1]


def _radii(u: NDArray[np.float64], low: float, high: float) -> NDArray[np.float64]:
    """Density in proportion to r^-3, by inversion."""
    return np.asarray((low**-2 + u * (high**-2 - low**-2)) ** -0.5)


def _cells(x: float, y: float, r: float) -> tuple[tuple[slice, slice], NDArray[np.bool_]]:
    """The part of the grid around a disc, and the mask of its cells inside the disc."""
    rows, columns = _GRID * 2 // 3, _GRID
    per = columns / 1.5
    cx, cy = (x + 0.75) * per, (y + 0.5) * per
    x0, x1 = max(int(cx - r * per), 0), min(int(cx + r * per) + 2, columns)
    y0, y1 = max(int(cy - r * per), 0), min(int(cy + r * per) + 2, rows)
    x1, y1 = max(x1, x0), max(y1, y0)
    dx = np.arange(x0, x1) + 0.5 - cx
    dy = np.arange(y0, y1) + 0.5 - cy
    return (slice(y0, y1), slice(x0, x1)), dx**2 + dy[:, None] ** 2 < (r * per) ** 2


def _disc(x: float, y: float, r: float) -> NDArray[np.float64]:
    """A polygon of the disc's area, with as many corners as its size asks for."""
    corners = int(np.clip(round(160 * np.sqrt(r)), 12, 96))
    angle = 2 * np.pi * np.arange(corners) / corners
    share = 2 * np.pi / corners
    r *= np.sqrt(share / np.sin(share))
    return np.asarray(np.c_[x + r * np.cos(angle), y + r * np.sin(angle)])
