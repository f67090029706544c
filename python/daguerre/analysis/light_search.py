"""Finds the directions from which light arrives at a film point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import BriefRecord
from daguerre.lenses.sag import sag

from .bench import Bench, BoolArray, FloatArray

MARGIN = 1.02  # factor on the last surface's clear diameter
START = 24  # cells across the last surface
ENOUGH = 400  # cells that cover the iris
DEEPEST = 12  # most halvings of a cell on the way to them
BULGE = 0.5  # share by which the image of a cell may exceed the box around its corners
FEW = 64  # lit cells below which the search looks closer
CLOSER = 2  # halvings of a cell then
GRAZING = 0.999  # largest direction cosine
QUARTERS = np.array([[0, 0], [1, 0], [0, 1], [1, 1]])

IntArray = NDArray[np.int64]


@dataclass(frozen=True, repr=False)
class Light(BriefRecord):
    """Light at a film point, in direction cosines.

    Attributes:
        low, high: Bounds of the light, shape (2,).
        seen: Directions of light, evenly spaced, shape (N, 2).
    """

    low: FloatArray
    high: FloatArray
    seen: FloatArray

    @property
    def width(self) -> float:
        """Diagonal of the bounds."""
        return float(np.linalg.norm(self.high - self.low))


def light_at(bench: Bench, film: FloatArray, nm: float) -> Light | None:
    """Finds the light of a film point (2,), mm; None: no light arrives.

    A direction leads to a point of the stop. Cells of directions are halved and kept while their
    images on the stop may overlap the iris. So a small iris is found wherever aberrations move the
    pupil, and a part of it where mounts block the chief ray.
    """
    low, high = _last_surface(bench, film)
    cells, size = _toward_iris(bench, film, nm, low, (high - low) / START)
    for closer in range(CLOSER + 1):
        if closer:
            cells, size = _halved(cells), 0.5 * size
        middles = low + (cells + 0.5) * size
        seen = middles[passes(bench, film, middles, nm) > 0]
        if len(seen) >= FEW:
            break
    if not len(seen):
        return None
    return Light(seen.min(axis=0) - 1.5 * size, seen.max(axis=0) + 1.5 * size, seen)


def passes(
    bench: Bench, film: FloatArray, cosines: FloatArray, nm: float, *, clip: bool = True
) -> FloatArray:
    """Transmittance of rays from a film point along direction cosines, shape (N,); 0 if stopped."""
    origins, directions = _rays(bench, film, cosines)
    rays = bench.rays(origins, directions, nm, to_film=False, clip=clip)
    inside = (cosines**2).sum(axis=1) < 1
    return np.where(rays.passed & inside, rays.transmittance, 0.0)


def _rays(bench: Bench, film: FloatArray, cosines: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Origins and directions of rays from the film; the cosines are of the light, toward it."""
    z = np.sqrt(np.maximum(1 - (cosines**2).sum(axis=1), 1e-9))
    directions = -np.column_stack([cosines, z])
    return np.broadcast_to([*film, bench.film_z], directions.shape), directions


def _last_surface(bench: Bench, film: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Bounds of the directions from the last surface, through which all light comes."""
    last, everywhere = bench.lens.surfaces[-1], np.full(2, GRAZING)
    if not last.semi_diameter or any(last.tilt):
        return -everywhere, everywhere
    angle = 2 * np.pi * np.arange(64) / 64
    rim = last.semi_diameter * np.column_stack([np.cos(angle), np.sin(angle)])
    height = sag(last, *rim.T)
    depth = bench.film_z - bench.lens.vertices[-1] - last.decenter[2]
    away = np.concatenate([np.full(64, depth), depth - height])
    if not (away > 0).all():
        return -everywhere, everywhere
    across = film - MARGIN * np.concatenate([rim, rim]) - last.decenter[:2]
    cosines = across / np.hypot(away, np.hypot(*across.T))[:, None]
    return cosines.min(axis=0), cosines.max(axis=0)


def _toward_iris(
    bench: Bench, film: FloatArray, nm: float, low: FloatArray, size: FloatArray
) -> tuple[IntArray, FloatArray]:
    """Cells with images that may overlap the iris, as multiples of their size, and the size."""
    cells = np.stack(np.meshgrid(*2 * [np.arange(START)]), -1).reshape(-1, 2)
    for halvings in range(DEEPEST + 1):
        if halvings:
            cells, size = _halved(cells), 0.5 * size
        cells = cells[_overlap_iris(bench, film, nm, low, size, cells)]
        if not 0 < len(cells) < ENOUGH:
            break
    return cells, size


def _overlap_iris(
    bench: Bench, film: FloatArray, nm: float, low: FloatArray, size: FloatArray, cells: IntArray
) -> BoolArray:
    """Whether the images of cells on the stop, ignoring mounts, may overlap the iris, (N,)."""
    corners = cells[:, None] + QUARTERS
    wide = int(corners.max()) + 1
    nodes, which = np.unique(corners @ [wide, 1], return_inverse=True)
    at = low + np.column_stack(np.divmod(nodes, wide)) * size
    rays = bench.rays(*_rays(bench, film, at), nm, to_film=False, clip=False)
    images = rays.iris[which.reshape(-1, 4)]
    least, most = np.fmin.reduce(images, axis=1), np.fmax.reduce(images, axis=1)
    bulge = BULGE * (most - least)
    away = np.maximum(np.maximum(least - bulge, -most - bulge), 0)
    return np.asarray(np.hypot(*away.T) <= bench.iris_radius)


def _halved(cells: IntArray) -> IntArray:
    return np.asarray((2 * cells[:, None] + QUARTERS).reshape(-1, 2))
